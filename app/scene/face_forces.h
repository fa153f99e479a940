// SPDX-License-Identifier: Apache-2.0
// The water's force on a face, taken apart for the eye.
#pragma once

#include <span>

#include "mercury/configuration.h"
#include "mercury/robot.h"
#include "mercury/vec3.h"

namespace mercury {

struct FaceForce {
  Vec3 center;     // of the face [m]
  float area = 0;  // [m2]
  Vec3 drag;       // the part along the flow past the face [N]
  Vec3 lift;       // the part across it [N]
};

// Whether an environment acts on faces.
bool has_face_forces(const Environment& environment);

// Paper, equation 1, as the simulation computes it. Positions and velocities are the robot's. Without face forces in
// this environment, drag and lift are zero.
FaceForce face_force(const Environment& environment, const Face& face, std::span<const Vec3> positions,
                     std::span<const Vec3> velocities);

}  // namespace mercury
