// SPDX-License-Identifier: Apache-2.0
// write_test_runs FOLDER: run folders for the tests that are written in Python, and to look at.
#include <cstdio>

#include "tests/evolution/run_folder/test_run.h"

int main(int count, char** arguments) {
  using namespace mercury;
  if (count != 2) return 2;
  const std::filesystem::path folder = arguments[1];
  const auto make = [&](const std::string& name, const RunSettings& settings) {
    RunFolder run = RunFolder::create(folder / name, settings, true, byte_space);
    evolve(run);
    run.write_all();
  };
  try {
    RunSettings settings = test_settings(60);
    settings.evolution.algorithm.population = 40;
    make("afpo", settings);
    settings.evolution.algorithm.crossover = 0;
    make("one-parent", settings);
    settings.evolution.algorithm.crossover = 0.25;
    settings.evolution.algorithm.name = "nsga2";
    settings.evolution.objectives = {"distance", "size - 0.1 * distance"};
    make("nsga2", settings);
    settings.evolution.objectives = {"distance"};
    settings.evolution.algorithm.name = "map-elites";
    settings.evolution.algorithm.axes = {{.quantity = "size", .lowest = -1, .highest = 1, .cells = 16},
                                         {.quantity = "height", .lowest = -1, .highest = 1, .cells = 10}};
    make("map-elites", settings);
    settings.evolution.algorithm.axes.pop_back();
    make("strip", settings);
  } catch (const InputError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
