// SPDX-License-Identifier: Apache-2.0
#include "robots/voxel/spring_cells.h"

#include <algorithm>
#include <cmath>

namespace mercury {

std::array<int, 3> SpringCells::corner(std::uint16_t mass) const {
  const Vec3& at = robot_.masses[mass];
  const auto number = [&](float place, int cells) {
    return static_cast<int>(std::lround(place / edge_ + cells / 2.0));
  };
  return {number(at.x, size_[0]), number(at.y, size_[1]), number(at.z, size_[2])};
}

std::array<int, 3> SpringCells::direction(const Spring& spring) const {
  const auto a = corner(spring.a), b = corner(spring.b);
  return {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
}

// Along an axis on which the ends differ there is one cell between them, else there are two beside them.
std::vector<std::size_t> SpringCells::of(const Spring& spring) const {
  const auto a = corner(spring.a), b = corner(spring.b);
  std::array<int, 3> first{}, last{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    first[axis] = std::max(0, a[axis] == b[axis] ? a[axis] - 1 : std::min(a[axis], b[axis]));
    last[axis] = std::min(size_[axis] - 1, std::min(a[axis], b[axis]));
  }
  const auto row = static_cast<std::size_t>(size_[0]), layer = row * static_cast<std::size_t>(size_[1]);
  std::vector<std::size_t> cells;
  for (int z = first[2]; z <= last[2]; ++z)
    for (int y = first[1]; y <= last[1]; ++y)
      for (int x = first[0]; x <= last[0]; ++x)
        cells.push_back(static_cast<std::size_t>(x) + row * static_cast<std::size_t>(y) +
                        layer * static_cast<std::size_t>(z));
  return cells;
}

}  // namespace mercury
