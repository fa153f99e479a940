// SPDX-License-Identifier: Apache-2.0
// What a robot looks like whatever it does: made once, on whatever thread, and shared by all scenes that show it.
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
  std::shared_ptr<const render::PreparedBody> body;  // its looks are material ids
  render::Bounds box;                                // at rest [m]
  Eigen::Vector3f middle{0, 0, 0};                   // mean of its masses at rest [m]
  bool grown = false;                                // from a network: drawn smooth
  std::array<bool, max_materials> materials{};       // those that its springs are of
};

std::shared_ptr<const RobotShape> shape_of(const Robot& robot);
// Of all of them, for a renderer.
std::shared_ptr<const render::BodyData> bodies_of(std::span<const std::shared_ptr<const RobotShape>> shapes);

}  // namespace mercury
