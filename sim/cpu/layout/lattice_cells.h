// SPDX-License-Identifier: Apache-2.0
// A robot as a pattern of lattice cells, one per mass. Robots of similar shape have many cells in common.
#pragma once

#include <compare>
#include <cstdint>
#include <vector>

#include "mercury/robot.h"

namespace mercury::cpu {

struct LatticeCell {
  std::uint8_t x = 0, y = 0, z = 0;
  friend constexpr auto operator<=>(const LatticeCell&, const LatticeCell&) = default;
};

// Wider robots have no pattern: they are too large to gain from a lockstep group.
inline constexpr int max_cells_across = 32;

// The cell of each mass at rest. Cells are as wide as the shortest spring; the lowest corner of the robot is in cell
// (0, 0, 0). Empty if two masses share a cell or the robot is too wide.
std::vector<LatticeCell> lattice_cells_of(const Robot& robot);

// The same pattern, turned and mirrored so that it is widest along x, then y, and has most masses in the lower half of
// each axis. Robots that were built in different poses then have more cells in common.
std::vector<LatticeCell> in_common_pose(const std::vector<LatticeCell>& cells);

}  // namespace mercury::cpu
