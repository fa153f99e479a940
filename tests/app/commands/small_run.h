// SPDX-License-Identifier: Apache-2.0
// A small real run of an evolution, made by the library.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "mercury/evolution.h"
#include "mercury/run_folder.h"

namespace mercury::test {

// Voxel robots of at most 3x2x2 in `ocean-simple`, half a second per trial with steps of 2 ms: 6 robots per generation.
inline RunSettings small_run(const std::string& algorithm = "afpo", int generations = 6) {
  RunSettings settings{.program = "a test"};
  EvolutionSettings& evolution = settings.evolution;
  evolution.algorithm = {.name = algorithm, .population = 6};
  if (algorithm_named(algorithm).of_behavior)
    evolution.algorithm.axes = {{.quantity = "masses", .lowest = 0, .highest = 40, .cells = 4},
                                {.quantity = "muscle_share", .lowest = 0, .highest = 1, .cells = 2}};
  evolution.trials.seconds = 0.5;
  evolution.configuration.dt = 2e-3;
  evolution.configuration.environment = OceanSimple{};
  evolution.configuration.device.kind = DeviceKind::cpu;
  evolution.generations = generations;
  settings.space.kind = "voxel";
  settings.space.values["voxels"] = SizeRange{{1, 1, 1}, {3, 2, 2}};
  return settings;
}

// Takes `most` generations, or all that were planned.
inline void make_run(const std::string& folder, const RunSettings& settings, int most = 1000) {
  RunFolder run = RunFolder::create(folder, settings);
  Evolution evolution(settings.evolution, run.space());
  const std::unique_ptr<Assessor> assessor = make_assessor(settings.evolution);
  for (int i = 0; i < most; ++i) {
    const std::optional<Generation> generation = evolution.advance(*assessor);
    if (!generation) break;
    run.append(*generation, {.seconds = 0.5, .device = assessor->device_name()});
  }
  run.write_all();
}

}  // namespace mercury::test
