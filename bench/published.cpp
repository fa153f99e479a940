// SPDX-License-Identifier: Apache-2.0
// Compares Mercury with the published kernel in one run on one GPU: bench_published [robots] [voxels per side]
#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "bench/full_cube.h"
#include "bench/published_kernel.cuh"
#include "mercury/cuda_devices.h"
#include "mercury/random_voxel.h"
#include "mercury/simulation.h"

namespace {

using namespace mercury;

double measure_mercury(std::span<const Robot> robots, double min_seconds) {
  Simulation simulation({.device = {.kind = DeviceKind::cuda}}, robots);
  simulation.step(50);
  double springs = 0;
  for (const Robot& robot : robots) springs += static_cast<double>(robot.springs.size());
  const double before = simulation.busy_seconds();
  std::int64_t steps = 0;
  for (std::int64_t n = 100; simulation.busy_seconds() - before < min_seconds; n *= 2, steps = simulation.steps() - 50)
    simulation.step(n);
  return springs * static_cast<double>(steps) / (simulation.busy_seconds() - before);
}

// The largest distance between a mass and the same mass of the published kernel after a tenth of a second [m].
float disagreement(const Robot& robot) {
  constexpr int steps = 100;
  Simulation simulation({.device = {.kind = DeviceKind::cuda}}, std::span(&robot, 1));
  simulation.step(steps);
  const std::vector<Vec3> ours = simulation.positions(0), theirs = published::positions_after(robot, steps);
  float most = 0;
  for (std::size_t i = 0; i < ours.size(); ++i) most = std::max(most, length(ours[i] - theirs[i]));
  return most;
}

}  // namespace

int main(int argc, char** argv) try {
  const int count = argc > 1 ? std::atoi(argv[1]) : 528, side = argc > 2 ? std::atoi(argv[2]) : 10;
  if (cuda_device_count() == 0) {
    std::puts("no CUDA device: nothing to measure");
    return 0;
  }
  if (count < 1 || side < 1) {
    std::fputs("bench_published [robots >= 1] [voxels per side >= 1]\n", stderr);
    return 2;
  }
  RandomVoxelOptions full = full_cube(side);
  full.frequencies = 5;
  const std::vector<Robot> robots = random_voxel_robots(full, 1, static_cast<std::size_t>(count));
  const double ours = measure_mercury(robots, 1), theirs = published::measure(robots, 1).springs_per_second;
  std::printf("%s, %d robots of %zu masses and %zu springs, force solver, ocean\n", cuda_device_name(0).c_str(), count,
              robots[0].masses.size(), robots[0].springs.size());
  std::printf("as published   %.3e springs/s\nMercury        %.3e springs/s   %.1f times as many\n", theirs, ours,
              ours / theirs);
  std::printf("largest disagreement after 0.1 s: %.1e m\n", static_cast<double>(disagreement(robots[0])));
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "bench_published: %s\n", error.what());
  return 1;
}
