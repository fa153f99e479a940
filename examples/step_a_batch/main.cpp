// SPDX-License-Identifier: Apache-2.0
// Steps 64 random voxel robots for five seconds and prints how far each has swum.
#include <cstdio>

#include <mercury/random_voxel.h>
#include <mercury/simulation.h>

int main() {
  const auto robots = mercury::random_voxel_robots({}, /*seed=*/1, /*count=*/64);
  mercury::Simulation simulation({.dt = 1e-3, .environment = mercury::Ocean{}}, robots);

  const auto before = simulation.telemetry();
  simulation.step(5000);
  const auto after = simulation.telemetry();

  std::printf("%s, %.1f s simulated\n", simulation.device_name().c_str(), simulation.time());
  for (std::size_t i = 0; i < simulation.size(); ++i) {
    const float distance = mercury::length(after[i].center_of_mass - before[i].center_of_mass);
    std::printf("%-14s %6.3f m\n", robots[i].name.c_str(), distance);
  }
}
