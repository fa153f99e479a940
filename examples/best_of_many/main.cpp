// SPDX-License-Identifier: Apache-2.0
// Prints which of many random robots swims farthest: best_of_many [ROBOTS]. It takes any number of robots, because each
// is made when it is needed and forgotten when its result is there.
#include <cstdio>
#include <cstdlib>
#include <memory>

#include <mercury/evaluator.h>
#include <mercury/random_voxel.h>

int main(int argc, char** argv) {
  const std::size_t count = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 300;
  // Called on all cores while the devices step robots that were made before.
  const auto source = [](std::size_t index) {
    return std::make_shared<const mercury::Robot>(mercury::random_voxel_robot({}, /*seed=*/1, index));
  };
  mercury::Evaluator evaluator({.configuration = {.dt = 1e-3, .environment = mercury::Ocean{}}, .steps = 3000}, source,
                               count);

  std::shared_ptr<const mercury::Robot> best;
  float farthest = -1;
  while (const auto result = evaluator.next()) {  // in the order of the indices
    if (!result->failure.empty() || result->end.exploded) continue;
    const float distance = mercury::length(result->end.center_of_mass - result->start.center_of_mass);
    if (distance <= farthest) continue;
    farthest = distance;
    best = result->robot;
    std::printf("%-14s %6.3f m\n", best->name.c_str(), distance);
  }
  std::printf("the best of %zu on %s: %s\n", count, evaluator.device_name().c_str(),
              best ? best->name.c_str() : "none");
  return best ? 0 : 1;
}
