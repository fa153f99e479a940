// SPDX-License-Identifier: Apache-2.0
#include "sim/cpu/layout/lattice_cells.h"

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <functional>

#include "sim/physics/springs.h"

namespace mercury::cpu {

std::vector<LatticeCell> lattice_cells_of(const Robot& robot) {
  if (robot.springs.empty()) return {};
  float shortest_squared = squared_length(robot.masses[robot.springs[0].b] - robot.masses[robot.springs[0].a]);
  for (const Spring& spring : robot.springs)
    shortest_squared = std::min(shortest_squared, squared_length(robot.masses[spring.b] - robot.masses[spring.a]));
  Vec3 low = robot.masses[0];
  for (const Vec3 x : robot.masses) low = {std::min(low.x, x.x), std::min(low.y, x.y), std::min(low.z, x.z)};

  constexpr std::size_t across = max_cells_across;
  const float per_meter = 1 / std::sqrt(shortest_squared);
  std::bitset<across * across * across> taken;
  std::vector<LatticeCell> cells;
  cells.reserve(robot.masses.size());
  for (const Vec3 x : robot.masses) {
    std::array<std::size_t, 3> cell{};
    const std::array<float, 3> distance{x.x - low.x, x.y - low.y, x.z - low.z};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float coordinate = distance[axis] * per_meter + 0.5f;  // rounded below; none is negative
      if (!(coordinate < static_cast<float>(across))) return {};
      cell[axis] = static_cast<std::size_t>(coordinate);
    }
    const std::size_t index = cell[0] + across * (cell[1] + across * cell[2]);
    if (taken[index]) return {};
    taken[index] = true;
    cells.push_back(
        {static_cast<std::uint8_t>(cell[0]), static_cast<std::uint8_t>(cell[1]), static_cast<std::uint8_t>(cell[2])});
  }
  return cells;
}

std::vector<LatticeCell> in_common_pose(const std::vector<LatticeCell>& cells) {
  using Axis = std::uint8_t LatticeCell::*;
  std::array<Axis, 3> axes{&LatticeCell::x, &LatticeCell::y, &LatticeCell::z};
  const auto widest = [&](Axis axis) { return std::ranges::max(cells, {}, axis).*axis; };
  std::ranges::stable_sort(axes, std::greater{}, widest);
  std::vector<LatticeCell> posed(cells.size());
  constexpr std::array<Axis, 3> to{&LatticeCell::x, &LatticeCell::y, &LatticeCell::z};
  for (std::size_t a = 0; a < 3; ++a) {
    const std::uint8_t last = widest(axes[a]);
    std::size_t sum = 0;
    for (const LatticeCell c : cells) sum += c.*axes[a];
    const bool mirrored = 2 * sum > last * cells.size();
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const std::uint8_t coordinate = cells[i].*axes[a];
      posed[i].*to[a] = mirrored ? static_cast<std::uint8_t>(last - coordinate) : coordinate;
    }
  }
  return posed;
}

}  // namespace mercury::cpu
