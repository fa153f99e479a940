// SPDX-License-Identifier: Apache-2.0
// Measures what telemetry of a whole batch adds to a call of 100 steps. Calls with and without telemetry take turns, so
// that a change of the clock rate affects both: bench_telemetry [device] [robots] [turns]
#include <cstdio>
#include <string>
#include <vector>

#include "bench/full_cube.h"
#include "bench/timing.h"
#include "mercury/random_voxel.h"
#include "mercury/simulation.h"

namespace mercury {
namespace {

void measure(const Configuration& configuration, const std::vector<Robot>& robots, int turns) {
  Simulation simulation(configuration, robots);
  constexpr int steps = 100;
  simulation.step(steps);
  std::vector<double> alone, together;
  for (int turn = 0; turn < turns; ++turn) {
    alone.push_back(seconds_of([&] {
      for (int call = 0; call < 4; ++call) simulation.step(steps);
    }));
    simulation.step(steps);
    (void)simulation.telemetry();
    together.push_back(seconds_of([&] {
      for (int call = 0; call < 4; ++call) {
        simulation.step(steps);
        (void)simulation.telemetry();
      }
    }));
  }
  std::printf("%-28s %5zu robots  %8.1f us a call of %d steps, %6.1f us with telemetry: +%.2f %%\n",
              simulation.device_name().c_str(), simulation.size(), 1e6 * median(alone) / 4, steps,
              1e6 * median(together) / 4, 100 * (median(together) / median(alone) - 1));
}

}  // namespace
}  // namespace mercury

int main(int argc, char** argv) {
  using namespace mercury;
  Configuration configuration;
  configuration.device = device_named(argc > 1 ? argv[1] : "auto");
  const std::size_t count = argc > 2 ? std::stoul(argv[2]) : 528;
  const int turns = argc > 3 ? std::stoi(argv[3]) : 200;
  RandomVoxelOptions full = full_cube(10);
  full.frequencies = 5;
  const std::vector<Robot> robots = random_voxel_robots(full, 1, count);
  measure(configuration, robots, turns);
}
