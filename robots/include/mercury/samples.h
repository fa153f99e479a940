// SPDX-License-Identifier: Apache-2.0
// The sample robots, by name: "sample:eel" stands for a file that is installed with the program.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace mercury {

// "sample:eel", ..., then those of the paper's physics, "sample:paper/beetle", ... None if the files are not there.
std::vector<std::string> sample_names();

// The file of a sample robot: .../eel.json for "sample:eel". "sample:beetle" is "sample:paper/beetle" if there is no
// other beetle. Other paths stay as they are ("./sample:eel" is a file).
// Throws InputError for an unknown name; it lists the known ones.
std::filesystem::path sample_or_path(const std::filesystem::path& path);

}  // namespace mercury
