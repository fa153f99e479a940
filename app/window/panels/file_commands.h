// SPDX-License-Identifier: Apache-2.0
// Opens and saves robots and scenes through the file dialog.
#pragma once

#include <functional>

#include "app/window/panels/panel_context.h"

namespace mercury::window {

// Asks for files and opens them.
void open_robots(PanelContext& context);
// Asks where to save the scene: robots, environment, solver, camera and looks.
void save_scene(PanelContext& context);
// Asks where to save the selected robots, or all robots if none is selected.
void save_robots(PanelContext& context);
// Calls `quit`, after asking the user if changes to robots would be lost.
void quit_with_confirmation(PanelContext& context, std::function<void()> quit);

}  // namespace mercury::window
