// SPDX-License-Identifier: Apache-2.0
// How far a robot got: one definition for tables, rankings, labels and objectives.
#pragma once

#include <cmath>

#include "mercury/configuration.h"
#include "mercury/vec3.h"

namespace mercury {

// From one place of the center of mass to another [m]; with ground along it, so a fall counts for nothing.
inline double distance_between(Vec3 start, Vec3 end, const Environment& environment) {
  const Vec3 d = end - start;
  const double x = d.x, y = d.y, z = has_ground(environment) ? 0 : d.z;
  return std::sqrt(x * x + y * y + z * z);
}

}  // namespace mercury
