// SPDX-License-Identifier: Apache-2.0
// A robot as a pattern of cells, one a mass, by which robots that are built in much the same way are found.
#pragma once

#include <compare>
#include <cstdint>
#include <vector>

#include "mercury/robot.h"

namespace mercury::cpu {

struct Cell {
  std::uint8_t x = 0, y = 0, z = 0;
  friend constexpr auto operator<=>(const Cell&, const Cell&) = default;
};

// More cells than these across are not looked at: a robot of so many masses gains nothing from others.
inline constexpr int most_cells_across = 32;

// The cell of each mass at rest, as wide as the shortest spring spans, from the lowest corner on; empty if two masses
// would share one, or the robot is too large.
std::vector<Cell> cells_of(const Robot& robot);

// The same pattern, turned and mirrored: widest along x, then y, and most masses in the lower half of each. Robots of
// other poses then have more in common.
std::vector<Cell> in_common_pose(const std::vector<Cell>& cells);

}  // namespace mercury::cpu
