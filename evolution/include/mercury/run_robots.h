// SPDX-License-Identifier: Apache-2.0
// Which robots of a run folder are meant, the same in `--robot` of the program and in Python.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "mercury/run_folder.h"

namespace mercury {

inline constexpr std::string_view best_of_run = "best", elites_of_run = "elites", champions_of_run = "champions";

// The robot files in the run's best/, sorted by name: what "champions" means. Throws InputError if there is no best/.
std::vector<std::filesystem::path> champion_files(const std::filesystem::path& run);

// "best": the best individual; "elites": all that live, the best first; else the one of this number. Throws
// ParameterError("robot", ...) for another word and for an individual that the run does not have.
std::vector<std::uint64_t> individuals_named(const RunHistory& run, const std::string& choice);

}  // namespace mercury
