# SPDX-License-Identifier: Apache-2.0
# Writes the table of the program's commands: each app/commands/NAME_command.cpp defines add_NAME_command().
#
#     cmake -DFOLDER=app/commands -DOUTPUT=command_table.h -P CommandTable.cmake
file(GLOB names RELATIVE ${FOLDER} ${FOLDER}/*_command.cpp)
list(TRANSFORM names REPLACE "_command[.]cpp$" "")
list(TRANSFORM names REPLACE "(.+)" "add_\\1_command" OUTPUT_VARIABLE functions)
list(TRANSFORM names REPLACE "(.+)" "{\"\\1\", add_\\1_command}" OUTPUT_VARIABLE rows)
list(JOIN functions ", " functions)
list(JOIN rows ", " rows)
file(CONFIGURE OUTPUT ${OUTPUT} @ONLY CONTENT [[
// Written by cmake/CommandTable.cmake.
#pragma once

#include <string_view>

#include "app/options/command.h"

namespace mercury {

AddCommand @functions@;

struct NamedCommand {
  std::string_view name;
  AddCommand* add;
};
// By their names.
inline constexpr NamedCommand command_table[] = {@rows@};

}  // namespace mercury
]])
