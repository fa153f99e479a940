// SPDX-License-Identifier: Apache-2.0
// Commands on the whole scene that panels, menus and keys share.
#pragma once

#include <functional>

#include "app/window/panels/panel_context.h"

namespace mercury::window {

// Runs `act` while the scene's view settings hold the camera of the window, and then restores them.
void with_window_camera(PanelContext& context, const std::function<void()>& act);

// Copies the command line that makes this scene to the clipboard. `subcommand`: "view" or "render".
void copy_as_command(PanelContext& context, const char* subcommand);

// Switches the drag arrows on or off.
void toggle_drag_arrows(PanelContext& context);

}  // namespace mercury::window
