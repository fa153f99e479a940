// SPDX-License-Identifier: Apache-2.0
// The part of the View panel that chooses what the colors show.
#pragma once

#include <utility>

#include "app/scene/view_settings.h"
#include "app/window/toolkit/event_log.h"
#include "app/window/toolkit/key_map.h"
#include "mercury/configuration.h"

namespace mercury::window {

// Draws one button per quantity of color_quantities(), and the scale, which is fixed as it is `shown` now. Returns true
// if `view` changed.
bool draw_color_section(ViewSettings& view, std::pair<float, float> shown, const Environment& environment,
                        const KeyMap& keys, EventLog& log);

// Colors by a quantity, with its usual scale. Shows the legend if it has values, as the command line does.
void color_by(ViewSettings& view, const ColorQuantity& quantity);

// The quantity that a command colors by; nullptr if it does not color.
const ColorQuantity* quantity_of(Action action);

}  // namespace mercury::window
