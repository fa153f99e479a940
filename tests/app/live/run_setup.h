// SPDX-License-Identifier: Apache-2.0
// Small runs of an evolution for tests: a few generations of voxel robots, a tenth of a second each.
#pragma once

#include <filesystem>
#include <string>

#include "mercury/run_folder.h"

namespace mercury::test {

inline RunSettings small_run(const std::string& algorithm = "ga") {
  RunSettings run{.program = "Mercury, a test"};
  EvolutionSettings& evolution = run.evolution;
  evolution.algorithm.name = algorithm;
  evolution.algorithm.population = 8;
  evolution.algorithm.crossover = 0.5;
  if (algorithm_named(algorithm).of_behavior)
    evolution.algorithm.axes = {{.quantity = "masses", .lowest = 8, .highest = 30, .cells = 4},
                                {.quantity = "muscle_share", .cells = 3},
                                {.quantity = "symmetry", .cells = 2}};
  evolution.trials.seconds = 0.1;
  evolution.configuration.device = {.kind = DeviceKind::cpu, .threads = 1};
  evolution.generations = 6;
  run.space.kind = "voxel";
  run.space.values["size"] = SizeRange{{2, 2, 2}, {3, 2, 2}};
  return run;
}

// The process that evolves: it writes the folder, generation by generation.
class SmallRun {
 public:
  explicit SmallRun(const std::filesystem::path& folder, const RunSettings& settings = small_run())
      : folder_(RunFolder::create(folder, settings)), evolution_(settings.evolution, folder_.space()),
        assessor_(make_assessor(settings.evolution)) {}

  void advance(int generations) {
    for (int i = 0; i < generations; ++i)
      if (const auto generation = evolution_.advance(*assessor_)) folder_.append(*generation, {.device = "test"});
  }

 private:
  RunFolder folder_;
  Evolution evolution_;
  std::unique_ptr<Assessor> assessor_;
};

}  // namespace mercury::test
