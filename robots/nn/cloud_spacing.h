// SPDX-License-Identifier: Apache-2.0
// Spreads a cloud of points more evenly, so that short springs do not stand beside long ones.
//
// A spring of 3 mm is as stiff, in N/m, as one of 30 cm. Where the long one moves its ends by 4 cm, the short one is
// torn to ten times its length. So
//
//   1. points go that are nearer than `distance` to one that stays, from the outermost point inward: the shape stays;
//   2. those that stay push each other apart, in three small steps, up to twice the distance;
//   3. points that came too near to each other on the way go, as in 1.
//
// In a cloud of pairs, both points of a pair stay or go; a pair whose points are too near to each other becomes one
// point, half way between. So a mirrored cloud stays mirrored.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "mercury/vec3.h"

namespace mercury {

// The side of a cube that holds a point's share of the cloud's volume [m]. The volume is that of the solid ellipsoid
// with the same second moments: it is fast to find, and does not depend on the cloud's direction or on how dense the
// cloud is where. 0 if the points lie in one plane.
double mean_spacing(std::span<const Vec3> places);

// A point that stayed.
struct SpreadPoint {
  std::size_t index = 0;  // in the cloud; for a pair that became one point, that of its first
  Vec3 place;
};

// The points that stay, sorted by index. Any two of them are at least `distance` [m] apart, which is above 0.
// `in_pairs`: points 2 i and 2 i + 1 are a pair. Places lie within [-1, 1]^3. Depends on the arguments alone, bit for
// bit on every machine, and takes time in proportion to the points.
std::vector<SpreadPoint> spread(std::span<const Vec3> places, bool in_pairs, double distance);

}  // namespace mercury
