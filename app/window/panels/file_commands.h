// SPDX-License-Identifier: Apache-2.0
// Opens, saves and exports robots and scenes through the file dialog.
#pragma once

#include <functional>
#include <string>

#include "app/window/panels/panel.h"

namespace mercury::window {

// Asks for files and opens them.
void open_robots(PanelContext& context);
// Asks where to save the scene: robots, environment, solver, camera and looks.
void save_scene(PanelContext& context);
// Asks where to save the selected robots, or all robots if none is selected.
void save_robots(PanelContext& context);
// Calls `quit`, after asking the user if changes to robots would be lost.
void quit_with_confirmation(PanelContext& context, std::function<void()> quit);

// Calls save(false). If files exist already, asks the user and calls save(true). Shows the result; after a
// failure the file dialog opens again as the user left it. `what` names the contents in messages: "ranking".
void save_with_confirmation(PanelContext& context, const std::string& what,
                            std::function<SaveResult(bool overwrite)> save);

// Asks for a file and saves the text that make() returns then.
void save_csv(PanelContext& context, const std::string& what, std::function<std::string()> make);

// Exports a robot for other programs through the file dialog: the selected one, else the first.
// Its current pose.
void export_pose(PanelContext& context);
// Its motion from time 0: asks for how long, and where.
void export_motion(PanelContext& context);

}  // namespace mercury::window
