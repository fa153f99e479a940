// SPDX-License-Identifier: Apache-2.0
#include "app/live/carried_state.h"

#include <array>
#include <cmath>
#include <map>
#include <vector>

namespace mercury {
namespace {

// Masses nearer to each other than this are one: no spring is that short.
using Place = std::array<long long, 3>;
Place place_of(Vec3 rest) {
  const auto step = [](float x) { return std::llround(static_cast<double>(x) / (0.25 * min_rest_length)); };
  return {step(rest.x), step(rest.y), step(rest.z)};
}

}  // namespace

std::optional<State> carried_state(const Robot& before, const State& state, const Robot& after) {
  if (state.exploded || state.positions.size() != before.masses.size()) return std::nullopt;
  std::map<Place, std::size_t> places;
  for (std::size_t i = 0; i < before.masses.size(); ++i) places.emplace(place_of(before.masses[i]), i);
  State carried{.positions = after.masses, .velocities = std::vector<Vec3>(after.masses.size())};
  std::vector<std::size_t> kept, added;
  const auto take = [&](std::size_t mass, std::size_t from) {
    carried.positions[mass] = after.masses[mass] + (state.positions[from] - before.masses[from]);
    carried.velocities[mass] = state.velocities[from];
  };
  for (std::size_t i = 0; i < after.masses.size(); ++i) {
    const auto found = places.find(place_of(after.masses[i]));
    (found == places.end() ? added : kept).push_back(i);
    if (found == places.end()) continue;
    carried.positions[i] = state.positions[found->second];
    carried.velocities[i] = state.velocities[found->second];
  }
  if (kept.empty()) return std::nullopt;
  for (const std::size_t mass : added) {
    std::size_t nearest = 0;
    float least = INFINITY;
    for (std::size_t i = 0; i < before.masses.size(); ++i)
      if (const float distance = length(before.masses[i] - after.masses[mass]); distance < least) {
        least = distance;
        nearest = i;
      }
    take(mass, nearest);
  }
  return carried;
}

}  // namespace mercury
