// SPDX-License-Identifier: Apache-2.0
// The part of a robot's drawing that does not change while it moves: made once, on any thread, and shared by all scenes
// that show the robot.
#pragma once

#include <Eigen/Core>

#include <array>
#include <memory>
#include <span>

#include "mercury/robot.h"
#include "render/body_data.h"
#include "render/camera.h"

namespace mercury {

struct RobotShape {
  std::shared_ptr<const render::PreparedBody> body;  // its material indices are material ids
  render::Bounds box;                                // at rest [m]
  Eigen::Vector3f center{0, 0, 0};                   // mean of its masses at rest [m]
  bool smooth = false;                               // grown by a network: drawn with a smooth skin
  std::array<bool, max_materials> materials{};       // ids of its springs' materials
};

std::shared_ptr<const RobotShape> shape_of(const Robot& robot);
// All of them together, for a renderer.
std::shared_ptr<const render::BodyData> bodies_of(std::span<const std::shared_ptr<const RobotShape>> shapes);

}  // namespace mercury
