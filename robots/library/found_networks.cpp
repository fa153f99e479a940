// SPDX-License-Identifier: Apache-2.0
// Random network robots that a search found: mercury new nn --best-of (docs/library.md has the commands).
#include "mercury/nn_robot.h"
#include "robots/library/designs.h"

namespace mercury::library {
namespace {

Robot found(const char* name, const char* environment, std::size_t points, std::uint64_t index) {
  constexpr std::uint64_t seed = 1;
  return grow(random_nn_genome({.points = points, .spacing = 0, .environment = environment}, seed, index), name);
}

}  // namespace

std::vector<Robot> found_network_robots() {
  return {found("flapper", "ocean", 64, 1962), found("rambler", "land", 192, 495), found("shuffler", "land", 192, 382)};
}

}  // namespace mercury::library
