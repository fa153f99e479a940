// SPDX-License-Identifier: Apache-2.0
// Robots from files and into files, as the user asks for it.
#pragma once

#include "app/window/picture/desk.h"

namespace mercury::window {

// Asks what, and opens it.
void open_robots(Desk& desk);
// Asks where to, for the selected robots, or all.
void save_robots(Desk& desk);
// Asks for a file, and saves the text that `make` gives then. `what` as in "ranking".
void save_csv(Desk& desk, const std::string& what, std::function<std::string()> make);
// Calls `quit`; where robots would be lost that cannot be made again, asks first.
void quit_with_care(Desk& desk, std::function<void()> quit);

}  // namespace mercury::window
