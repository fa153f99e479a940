// SPDX-License-Identifier: Apache-2.0
#include "evolution/run_folder/champions.h"

#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>

#include "evolution/run_folder/derived_files.h"
#include "evolution/run_folder/file_descriptor.h"
#include "mercury/error.h"
#include "mercury/robot_file.h"
#include "robots/whole_file.h"

namespace mercury {
namespace {

std::string file_name(int generation, std::uint64_t id) {
  char name[64];
  std::snprintf(name, sizeof name, "%05d-%07llu.json", generation, static_cast<unsigned long long>(id));
  return name;
}

std::optional<Robot> grown(const RunHistory& run, std::uint64_t id) {
  const GenomePointer genome = run.genome(id);  // a damaged journal is an error
  try {
    return run.grow(id);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

}  // namespace

void write_champions(const RunHistory& run) {
  const std::filesystem::path folder = run.folder() / champions_name;
  std::optional<std::uint64_t> previous;
  for (const GenerationSummary& generation : run.generations()) {
    if (generation.living == 0 || generation.best == previous) continue;
    previous = generation.best;
    const std::filesystem::path path = folder / file_name(generation.number, generation.best);
    std::error_code error;
    if (std::filesystem::exists(path, error)) continue;
    const std::optional<Robot> robot = grown(run, generation.best);
    if (!robot) continue;
    std::filesystem::create_directories(folder, error);
    if (error) fail(folder, error.value());
    save_robot(path, *robot);
  }
}

}  // namespace mercury
