// SPDX-License-Identifier: Apache-2.0
// Faces in pairs that share an edge. A pair reads and updates four masses, two single faces read and update six.
//
//     d-------c
//     |     / |      triangles (a, b, c) and (a, c, d)
//     |   /   |
//     | /     |
//     a-------b
#pragma once

#include <cstdint>
#include <vector>

#include "mercury/robot.h"

namespace mercury {

// A face without a free neighbor is a pair with d = a. Its second triangle has no area, so no force.
struct FacePair {
  std::uint16_t a = 0, b = 0, c = 0, d = 0;
  friend constexpr bool operator==(const FacePair&, const FacePair&) = default;
};

// Contains every face once. The vertex order of a face may differ from the robot's: another first corner, or the
// opposite orientation. Its force is the same.
// The vertex order of a pair follows from the rest positions of its masses, compared by z, then y, then x: a is before
// c, and b before d. So congruent pairs of different robots have the same order and can be computed in one vector.
std::vector<FacePair> pair_faces(const Robot& robot);

}  // namespace mercury
