// SPDX-License-Identifier: Apache-2.0
// The part of the View panel that chooses what the colours show.
#pragma once

#include <utility>

#include "app/scene/view_settings.h"
#include "app/window/toolkit/event_log.h"
#include "mercury/configuration.h"

namespace mercury::window {

// Draws one button per quantity of color_quantities(), and the scale, which is fixed as it is `shown` now. Returns true
// if `view` changed.
bool draw_color_section(ViewSettings& view, std::pair<float, float> shown, const Environment& environment,
                        EventLog& log);

// Colours by the quantity with this number, counted from 1 in the order of color_quantities(). Returns false if the
// environment does not have it.
bool color_by_number(ViewSettings& view, int number, const Environment& environment);

}  // namespace mercury::window
