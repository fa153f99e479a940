// SPDX-License-Identifier: Apache-2.0
// Measures a robot for its senses, on the host.
#pragma once

#include <span>
#include <vector>

#include "mercury/robot.h"
#include "sim/physics/senses.h"

namespace mercury {

struct SensedBody {
  std::vector<PlaceMeasures> places;
  BodyMeasures body;
};

// What the senses of the plan need. `positions` and `velocities` may be empty if they need none.
SensedBody measure_body(const Robot& robot, const BrainPlan& plan, std::span<const Vec3> positions,
                        std::span<const Vec3> velocities, bool ground);

// The rotation that brings the rest shape closest to these positions.
Rotation body_frame(const Robot& robot, std::span<const Vec3> positions);

}  // namespace mercury
