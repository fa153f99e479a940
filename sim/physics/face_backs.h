// SPDX-License-Identifier: Apache-2.0
// The mass behind a face: where its body is, for water that pushes outward faces alone (ResistiveDrag::one_sided).
//
//      d ----- c         Springs join it to all three corners. Of such masses it is the farthest from the middle of the
//     / .     /|         face at rest, and the first in the file of equally far ones; those in the plane of the face do
//    a ----- b |         not count. Half a side of a voxel, as (a, b, c), has the mass behind it that is diagonally
//    |  e . .|.+         across the voxel from its right angle, here e.
//    |       |/
//    +-------+           A face with no such mass, as those of a sheet, has water on both of its sides.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mercury/environment.h"
#include "mercury/robot.h"
#include "sim/physics/face_pairs.h"

namespace mercury {

inline bool has_one_sided_water(const Environment& environment) {
  const auto* water = std::get_if<ResistiveDrag>(&environment.water);
  return water && water->one_sided;
}

// Finds masses behind faces of a robot, which has to stay.
class FaceBacks {
 public:
  explicit FaceBacks(const Robot& robot);

  // The mass behind a face, or its corner a if there is none.
  std::uint16_t behind(const Face& face) const;

 private:
  std::span<const std::uint16_t> neighbors(std::uint16_t mass) const;

  const Robot& robot_;
  std::vector<std::uint32_t> start_;      // [mass + 1]
  std::vector<std::uint16_t> neighbors_;  // by mass, each sorted
};

// Behind (a, b, c) and (a, c, d).
struct PairBacks {
  std::uint16_t first = 0, second = 0;
};
std::vector<PairBacks> masses_behind(const Robot& robot, std::span<const FacePair> pairs);

}  // namespace mercury
