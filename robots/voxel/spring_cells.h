// SPDX-License-Identifier: Apache-2.0
// Where the springs of a voxel robot run in its grid.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "mercury/robot.h"

namespace mercury {

// Of a robot whose masses are corners of a grid of this size around the origin of coordinates; it must outlive this.
class SpringCells {
 public:
  SpringCells(const Robot& robot, std::array<int, 3> size, float edge) : robot_(robot), size_(size), edge_(edge) {}
  // The cells that have both ends of a spring as corners, x fastest; four at most.
  std::vector<std::size_t> of(const Spring& spring) const;
  // Between which corners of the grid it runs, as a step: (1, 0, 0) along x.
  std::array<int, 3> direction(const Spring& spring) const;
  std::array<int, 3> corner(std::uint16_t mass) const;  // of the grid

 private:
  const Robot& robot_;
  std::array<int, 3> size_;  // [cells]
  float edge_;               // of a cell [m]
};

}  // namespace mercury
