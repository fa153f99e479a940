// SPDX-License-Identifier: Apache-2.0
// Robots from files and into files, as the user asks for it.
#pragma once

#include "app/window/panels/panel_context.h"

namespace mercury::window {

// Asks what, and opens it.
void open_robots(PanelContext& context);
// Asks where to, for the selected robots, or all.
void save_robots(PanelContext& context);
// Asks for a file, and saves the text that `make` gives then. `what` as in "ranking".
void save_csv(PanelContext& context, const std::string& what, std::function<std::string()> make);
// Calls `quit`; where robots would be lost that cannot be made again, asks first.
void quit_with_confirmation(PanelContext& context, std::function<void()> quit);

}  // namespace mercury::window
