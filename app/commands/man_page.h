// SPDX-License-Identifier: Apache-2.0
// Manual pages, made from the list of commands.
#pragma once

#include <string>
#include <vector>

#include "app/commands/command_list.h"

namespace mercury {

// "mercury-new-voxel"; the page is the file mercury-new-voxel.1.
std::string man_page_name(const CommandDescription& command);

// The page of one of the commands, in the troff macros "man".
std::string man_page(const CommandDescription& command, const std::vector<CommandDescription>& all);

}  // namespace mercury
