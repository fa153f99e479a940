// SPDX-License-Identifier: Apache-2.0
// Converts the simulation's vectors to the renderer's.
#pragma once

#include <Eigen/Core>

#include "mercury/vec3.h"

namespace mercury {

inline Eigen::Vector3f eigen(Vec3 v) { return {v.x, v.y, v.z}; }

}  // namespace mercury
