// SPDX-License-Identifier: Apache-2.0
// Random voxel robots that a search found: mercury new voxel --best-of (docs/library.md has the commands).
#include "mercury/random_voxel.h"
#include "robots/library/designs.h"

namespace mercury::library {
namespace {

Robot found(const char* name, const char* environment, std::uint64_t index) {
  constexpr std::uint64_t seed = 1;
  Robot robot = random_voxel_robot({.environment = environment}, seed, index);
  robot.name = name;
  return robot;
}

}  // namespace

std::vector<Robot> found_voxel_robots() {
  return {found("paddler", "ocean", 1332), found("wriggler", "ocean", 1748), found("tumbler", "land", 1446)};
}

}  // namespace mercury::library
