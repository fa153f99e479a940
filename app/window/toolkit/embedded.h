// SPDX-License-Identifier: Apache-2.0
// Files that are built into the program: the font of the panels and the sample robots.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "app/base/embedded_file.h"
#include "mercury/robot.h"

namespace mercury::window {

// cmake/EmbedFiles.cmake writes this function at build time, from the font and robots/library.
std::span<const EmbeddedFile> embedded_files();

// The contents of a file; empty if no file has that name.
std::string_view embedded_file(std::string_view name);

// The sample robots made for an environment ("ocean", "land"), sorted by name; all of them if `environment` is empty.
std::vector<Robot> sample_robots(std::string_view environment);

}  // namespace mercury::window
