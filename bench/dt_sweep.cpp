// SPDX-License-Identifier: Apache-2.0
// Finds the time steps at which each solver stays bounded. Runs the same robots in every environment, with both
// solvers, at longer and longer steps, and prints a table in Markdown: bench_dt_sweep [SECONDS] [cpu|cuda]
//
// The robots are those of `--random voxel:8 --seed 1`. A cell holds the largest strain of any spring of any robot
// during the run, or the time at which the first robot exploded.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

#include "bench/timing.h"
#include "mercury/random_voxel.h"
#include "mercury/simulation.h"

namespace {

using namespace mercury;

struct Outcome {
  double largest_strain = 0;
  double exploded_at = -1;  // [s]; -1 = never
};

Outcome sweep_point(const Configuration& configuration, std::span<const Robot> robots, double seconds) {
  Simulation simulation(configuration, robots);
  const auto steps = static_cast<std::int64_t>(std::ceil(seconds / configuration.dt));
  const std::int64_t looks = std::min<std::int64_t>(steps, 200);
  Outcome outcome;
  for (std::int64_t look = 1; look <= looks; ++look) {
    simulation.step(steps * look / looks - simulation.steps());
    for (const Telemetry& telemetry : simulation.telemetry()) {
      if (telemetry.exploded && (outcome.exploded_at < 0 || telemetry.exploded_at < outcome.exploded_at))
        outcome.exploded_at = telemetry.exploded_at;
      outcome.largest_strain = std::max(outcome.largest_strain, static_cast<double>(telemetry.largest_strain));
    }
    if (outcome.exploded_at >= 0) break;
  }
  return outcome;
}

std::string shown(const Outcome& outcome) {
  char text[64];
  if (outcome.exploded_at >= 0)
    std::snprintf(text, sizeof text, "explodes at %.3g s", outcome.exploded_at);
  else
    std::snprintf(text, sizeof text, "%.2f", outcome.largest_strain);
  return text;
}

void print_table(const Environment& environment, std::span<const double> time_steps, std::span<const Robot> robots,
                 double seconds, const Device& device) {
  std::printf("`%s`, largest strain within %g s:\n\n| dt [s] | force | xpbd |\n|---|---|---|\n",
              std::string(name_of(environment)).c_str(), seconds);
  for (const double dt : time_steps) {
    std::printf("| %g |", dt);
    for (const Solver solver : {Solver::force, Solver::xpbd}) {
      const Configuration configuration{.dt = dt, .solver = solver, .environment = environment, .device = device};
      std::printf(" %s |", shown(sweep_point(configuration, robots, seconds)).c_str());
      std::fflush(stdout);
    }
    std::printf("\n");
  }
  std::printf("\n");
}

}  // namespace

int main(int argc, char** argv) try {
  const double seconds = argc > 1 ? seconds_from(argv[1]) : 20;
  const Device device = argc > 2 ? device_named(argv[2]) : Device{};
  const std::vector<Robot> robots = random_voxel_robots({}, 1, 8);
  const std::vector<double> in_water = {1e-3, 1e-2, 3e-2, 5e-2, 6e-2, 7e-2, 8e-2, 1e-1, 0.2, 0.5, 1, 2, 5};
  const std::vector<double> on_land = {1e-4, 1e-3, 2e-3, 3e-3, 4e-3, 5e-3, 6e-3, 8e-3, 1e-2, 2e-2, 5e-2, 0.1, 0.2, 0.5};
  print_table(Ocean{}, in_water, robots, seconds, device);
  print_table(OceanSimple{}, in_water, robots, seconds, device);
  print_table(Land{}, on_land, robots, seconds, device);
} catch (const std::exception& error) {
  std::fprintf(stderr, "bench_dt_sweep: %s\n", error.what());
  return 1;
}
