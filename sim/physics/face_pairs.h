// SPDX-License-Identifier: Apache-2.0
// Faces two by two, so that masses common to both are read once and forces on them added once.
#pragma once

#include <cstdint>
#include <vector>

#include "mercury/robot.h"

namespace mercury {

// Two triangles (a, b, c) and (a, c, d) that share an edge. A triangle without a neighbour left has d = a: its second
// triangle has no area and no force.
struct FacePair {
  std::uint16_t a = 0, b = 0, c = 0, d = 0;
  friend constexpr bool operator==(const FacePair&, const FacePair&) = default;
};

// Every face once. A face may be told from another corner or the other way around than in the robot; its force is the
// same. Pairs of two faces are told by where their masses are at rest (z first, then y, then x): a before c, b before
// d; so a pair of another robot in the same place is told the same way.
std::vector<FacePair> pair_faces(const Robot& robot);

}  // namespace mercury
