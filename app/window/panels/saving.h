// SPDX-License-Identifier: Apache-2.0
// Saves files, asking before it replaces any.
#pragma once

#include <functional>
#include <string>

#include "app/window/panels/panel_context.h"

namespace mercury::window {

// Calls save(false). If files exist already, asks the user and calls save(true). Shows the result; after a
// failure the file dialog opens again as the user left it. `what` names the contents in messages: "ranking".
void save_with_confirmation(PanelContext& context, const std::string& what,
                            std::function<SaveResult(bool overwrite)> save);

// Asks for a file and saves the text that make() returns then.
void save_csv(PanelContext& context, const std::string& what, std::function<std::string()> make);

}  // namespace mercury::window
