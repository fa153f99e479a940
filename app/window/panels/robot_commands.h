// SPDX-License-Identifier: Apache-2.0
// Commands on robots and on the whole scene that panels, menus and keys share.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "app/window/panels/panel.h"

namespace mercury::window {

// The selected robots; all robots if none is selected.
std::vector<RobotId> selected_or_all(const LiveScene& scene);

// The name of a robot; "?" if it does not exist.
std::string name_of_robot(const LiveScene& scene, RobotId robot);

// Moves the camera so that it shows these robots; all robots if the list is empty.
void frame_robots(PanelContext& context, const std::vector<RobotId>& robots);

// Makes random robots with the settings of context.creation, and increments the seed for the next time.
void generate_robots(PanelContext& context);

// Adds a mutated copy of each selected robot.
void mutate_selected(PanelContext& context);
// Adds a child of the two selected robots.
void breed_selected(PanelContext& context);
// Asks for a new name of the current robot.
void rename_selected(PanelContext& context);
void invert_selection(PanelContext& context);
// Removes all robots but these, as one edit. Nothing happens if the list is empty.
void keep_only(PanelContext& context, const std::vector<RobotId>& robots);
// Asks how many robots to keep. `order`: the best first; empty = those that went farthest at equal age.
void ask_for_best(PanelContext& context, std::vector<RobotId> order = {});

// Runs `act` while the scene's view settings hold the camera of the window, and then restores them.
void with_window_camera(PanelContext& context, const std::function<void()>& act);

// Copies the command line that makes this scene to the clipboard. `subcommand`: "view" or "render".
void copy_as_command(PanelContext& context, const char* subcommand);

// Switches the drag arrows on or off.
void toggle_drag_arrows(PanelContext& context);

}  // namespace mercury::window
