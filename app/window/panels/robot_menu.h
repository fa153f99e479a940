// SPDX-License-Identifier: Apache-2.0
// The menu of a right click on a robot, in the picture or in a list.
#pragma once

#include <functional>

#include "app/window/panels/panel_context.h"
#include "app/window/toolkit/key_bindings.h"

namespace mercury::window {

// Opens the menu when the item that was just drawn is right-clicked. Its robot is selected first, unless it is one of
// several that are.
void robot_menu_of_row(PanelContext& context, RobotId robot);

// Opens the menu for what was right-clicked in the picture.
void open_robot_menu(PanelContext& context, const Hit& hit);
// Draws the menu that is open. `execute` carries out a command.
void draw_robot_menu(PanelContext& context, const std::function<void(Action)>& execute);

}  // namespace mercury::window
