// SPDX-License-Identifier: Apache-2.0
// Files that are built into the program.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "mercury/robot.h"

namespace mercury::window {

struct EmbeddedFile {
  std::string_view name;  // "eel.json"
  std::string_view contents;
};

// Written at build time by cmake/EmbedFiles.cmake: the font of the panels, and robots/library.
std::span<const EmbeddedFile> embedded_files();

// The contents of one; empty if there is none of that name.
std::string_view embedded_file(std::string_view name);

// The sample robots that are made for an environment ("ocean", "land"), by name; all for an empty one.
std::vector<Robot> sample_robots(std::string_view environment);

}  // namespace mercury::window
