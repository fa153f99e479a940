// SPDX-License-Identifier: Apache-2.0
// What is drawn, and how.
#pragma once

#include "app/scene/view_settings.h"
#include "app/window/toolkit/event_log.h"
#include "app/window/toolkit/preferences.h"
#include "app/window/viewport/orbit_controller.h"
#include "mercury/configuration.h"

namespace mercury::window {

// True when the settings changed. Arrows and colours that the environment does not have are not offered.
bool draw_view_panel(ViewSettings& view, OrbitController& camera, Preferences& preferences,
                     const Environment& environment, std::size_t robots, EventLog& log);

// What a key does to the settings.
void toggle_drag_arrows(ViewSettings& view);
// `number` from 1, in the order of color_quantities(). False if the environment does not have that quantity.
bool color_by_number(ViewSettings& view, int number, const Environment& environment);

}  // namespace mercury::window
