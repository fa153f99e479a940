// SPDX-License-Identifier: Apache-2.0
#include "evolution/run_folder/run_robot.h"

#include <filesystem>
#include <string>

#include "mercury/origin.h"
#include "mercury/random.h"

namespace mercury {
namespace {

std::string run_name(const RunHistory& run) {
  const std::filesystem::path folder = std::filesystem::absolute(run.folder()).lexically_normal();
  return (folder.has_filename() ? folder.filename() : folder.parent_path().filename()).string();
}

}  // namespace

Robot run_robot(const RunHistory& run, std::uint64_t id) {
  Robot robot = run.genome(id)->grow(run_name(run) + "-" + std::to_string(id));
  const Individual& individual = run.individuals()[id];
  Ancestry ancestry{.generation = static_cast<std::uint64_t>(individual.generation)};
  for (const std::uint64_t parent : individual.parents)
    ancestry.parents.push_back(run_name(run) + "-" + std::to_string(parent));
  if (!individual.parents.empty()) ancestry.mutation_seed = individual.seed;
  if (individual.parents.size() > 1) ancestry.crossover_seed = seed_of(individual.seed, 0);
  robot.origin = with_ancestry(robot.origin, ancestry);
  return robot;
}

}  // namespace mercury
