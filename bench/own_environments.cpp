// SPDX-License-Identifier: Apache-2.0
// Measures what environments of robots' own (Simulation::set_environments()) cost: 20 steps of a batch with and
// without, which take turns, and the call itself for one robot and for all: bench_own_environments [device] [voxels per
// edge] [robots] [turns]
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
  Simulation shared(configuration, robots), own(configuration, robots);
  std::vector<std::size_t> all;
  std::vector<Environment> environments;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    all.push_back(i);
    environments.push_back(configuration.environment);
    environments.back().gravity.x = 1e-3f * static_cast<float>(i);
  }
  constexpr int steps = 20;
  std::vector<double> without, with, setting_one, setting_all;
  for (int turn = -1; turn < turns; ++turn) {
    setting_all.push_back(seconds_of([&] { own.set_environments(all, environments); }));
    setting_one.push_back(
        seconds_of([&] { own.set_environments(std::span(all).first(1), std::span(environments).first(1)); }));
    const double a = seconds_of([&] { shared.step(steps); }), b = seconds_of([&] { own.step(steps); });
    if (turn < 0) continue;
    without.push_back(a);
    with.push_back(b);
  }
  std::printf(
      "%s, %zu robots of %zu masses, %s: %d steps %.1f us, with their own environments %+.1f %%; setting one %.0f us, "
      "all %.0f us\n",
      shared.device_name().c_str(), robots.size(), robots[0].masses.size(),
      std::string(name_of(configuration.environment)).c_str(), steps, 1e6 * median(without),
      100 * (median(with) / median(without) - 1), 1e6 * median(setting_one), 1e6 * median(setting_all));
}

}  // namespace
}  // namespace mercury

int main(int argc, char** argv) {
  using namespace mercury;
  const int edge = argc > 2 ? std::stoi(argv[2]) : 10;
  const std::size_t count = argc > 3 ? std::stoul(argv[3]) : 528;
  const std::vector<Robot> robots = random_voxel_robots(full_cube(edge), 1, count);
  for (const char* environment : {"ocean", "ocean-simple", "land"})
    measure({.environment = environment_named(environment), .device = device_named(argc > 1 ? argv[1] : "auto")},
            robots, argc > 4 ? std::stoi(argv[4]) : 20);
}
