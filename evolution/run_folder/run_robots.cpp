// SPDX-License-Identifier: Apache-2.0
#include "mercury/run_robots.h"

#include <span>

#include "evolution/run_folder/derived_files.h"
#include "mercury/error.h"
#include "mercury/number_text.h"
#include "mercury/robot_file.h"

namespace mercury {

std::vector<std::filesystem::path> champion_files(const std::filesystem::path& run) {
  const std::filesystem::path folder = run / champions_name;
  std::error_code error;
  if (!std::filesystem::is_directory(folder, error))
    throw InputError(run.string(),
                     "has no champions in best/; checks.csv in it says why, and the robot \"best\" is the "
                     "best one all the same");
  return robot_files(std::span(&folder, 1));
}

std::vector<std::uint64_t> individuals_named(const RunHistory& run, const std::string& choice) {
  const std::span<const std::uint64_t> living = run.living();
  if (choice == elites_of_run) return {living.begin(), living.end()};
  if (choice == best_of_run && !living.empty()) return {living.front()};
  const std::size_t count = run.individuals().size();
  const auto id = parse_number<std::uint64_t>(choice);
  if (!id || *id >= count)
    throw ParameterError("robot", "\"" + choice.substr(0, 80) +
                                      "\" is not accepted; give best, elites, champions, or one of the " +
                                      std::to_string(count) + " robots of " + run.folder().string() + ", from 0 on");
  return {*id};
}

}  // namespace mercury
