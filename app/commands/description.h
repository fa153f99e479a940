// SPDX-License-Identifier: Apache-2.0
// Descriptions as mercury info prints them: a heading, then lines of what and how.
#pragma once

#include <string>

#include "app/recording/configuration_json.h"
#include "mercury/run_folder.h"

namespace mercury {

// What is described. Names come from files: what a terminal would obey is shown as an escape, here and below.
void print_heading(const std::string& text);
// "  masses      300"
void print_line(const std::string& what, const std::string& text);

// A run of an evolution, which may be going on.
void describe(const RunHistory& run);

}  // namespace mercury
