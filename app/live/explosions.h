// SPDX-License-Identifier: Apache-2.0
// Exploded robots, and where the spring that caused it is in the picture.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/live/picking.h"
#include "render/camera.h"
#include "render/vector.h"

namespace mercury {

// The first spring that became invalid in a robot.
struct CulpritSpring {
  std::uint32_t index = 0;       // in Robot::springs
  std::uint16_t a = 0, b = 0;    // its masses
  render::Vector3 at_a, at_b;    // their positions in the picture; the robot is frozen there [m]
  HitDetails::OfSpring figures;  // at the explosion
  render::Bounds surroundings;   // the part of the picture that shows the spring and enough of its robot
};

struct ExplodedRobot {
  RobotId robot = 0;
  std::size_t index = 0;  // in the snapshot
  std::string name;
  double time = 0;                      // of the explosion [s]
  std::optional<CulpritSpring> spring;  // nothing if the cause is no spring
};

// The exploded robots of a snapshot in the order of their explosions. `offsets`: per robot, added to its coordinates in
// the picture [m]. `boxes`: where each robot was last in the picture; empty = where it was at rest.
std::vector<ExplodedRobot> exploded_robots(const Snapshot& snapshot, std::span<const render::Vector3> offsets,
                                           std::span<const render::Bounds> boxes = {});

}  // namespace mercury
