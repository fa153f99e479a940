// SPDX-License-Identifier: Apache-2.0
// Robots that have exploded, and where the spring stands in the picture that went first.
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/live/picking.h"
#include "render/camera.h"

namespace mercury {

struct CulpritSpring {
  std::uint32_t index = 0;       // in Robot::springs
  std::uint16_t a = 0, b = 0;    // its masses
  Eigen::Vector3f at_a, at_b;    // they in the picture, where the robot is frozen [m]
  HitDetails::OfSpring figures;  // when it exploded
  render::Bounds surroundings;   // to be looked at: the spring, and as much around it as shows where it is
};

struct ExplodedRobot {
  RobotId robot = 0;
  std::size_t index = 0;  // at that snapshot
  std::string name;
  double time = 0;                      // of the explosion [s]
  std::optional<CulpritSpring> spring;  // nothing where no spring is to blame
};

// All of a snapshot, in the order in which they exploded. `offsets`: one a robot, added to its coordinates in the
// picture.
std::vector<ExplodedRobot> exploded_robots(const Snapshot& snapshot, std::span<const Eigen::Vector3f> offsets);

}  // namespace mercury
