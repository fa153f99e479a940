// SPDX-License-Identifier: Apache-2.0
// Measures what it costs to add robots to a batch and to remove some, for batches of different sizes:
// bench_batch_edits [cpu|cuda [robots]].
//
// The robots are random voxel robots. "step" is one step before the edit; "first step" is the one after it, which
// prepares what the edit needs. If an edit costs no more than what it adds or moves, both columns of an edit stay the
// same from row to row, but for the step itself.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <numeric>
#include <string_view>
#include <vector>

#include "bench/timing.h"
#include "mercury/random_voxel.h"
#include "mercury/simulation.h"

namespace {

using namespace mercury;

double milliseconds(const std::function<void()>& work) { return 1e3 * seconds_of(work); }

void measure(const Configuration& configuration, std::size_t size) {
  const std::vector<Robot> robots = random_voxel_robots({}, 1, size + 100);
  Simulation simulation(configuration, std::span(robots).first(size));
  simulation.step(10);
  double edit = 0;
  std::printf("%8zu %9.2f", size, milliseconds([&] { simulation.step(); }));
  const auto report = [&](const std::function<void()>& work) {
    edit = milliseconds(work);
    std::printf("   %9.2f %9.2f", edit, milliseconds([&] { simulation.step(); }));
  };
  report([&] { simulation.add(robots[size]); });
  report([&] { simulation.add(std::span(robots).subspan(size + 1, 99)); });
  std::vector<std::size_t> kept(simulation.size() - 1);
  std::iota(kept.begin(), kept.end(), std::size_t{1});
  report([&] { simulation.keep(kept); });
  kept.clear();
  for (std::size_t i = 0; i < simulation.size(); ++i)
    if (i % 2 == 0) kept.push_back(i);
  report([&] { simulation.keep(kept); });
  std::printf("\n");
}

}  // namespace

int main(int count, char** arguments) {
  Configuration configuration;
  configuration.device = {.kind = count > 1 && std::string_view(arguments[1]) == "cuda" ? DeviceKind::cuda
                                                                                        : DeviceKind::cpu};
  const std::size_t most = count > 2 ? std::strtoul(arguments[2], nullptr, 10) : 10000;
  std::printf("%s, times in ms\n", Simulation(configuration).device_name().c_str());
  std::printf("%8s %9s   %19s   %19s   %19s   %19s\n", "", "", "add 1", "add 99", "remove 1", "remove half");
  std::printf("%8s %9s", "robots", "step");
  for (int edit = 0; edit < 4; ++edit) std::printf("   %9s %9s", "edit", "1st step");
  std::printf("\n");
  for (std::size_t size = std::min<std::size_t>(100, most); size <= most; size *= 10) measure(configuration, size);
}
