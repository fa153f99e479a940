// SPDX-License-Identifier: Apache-2.0
// The part of a robot's drawing that does not change while it moves: made once, on any thread, and shared by all scenes
// that show the robot.
#pragma once

#include <array>
#include <memory>
#include <span>

#include "app/scene/group_layout.h"
#include "mercury/robot.h"
#include "render/body_data.h"
#include "render/camera.h"

namespace mercury {

struct RobotShape {
  std::shared_ptr<const render::PreparedBody> body;  // its material indices are material ids
  render::Bounds box;                                // at rest [m]
  Room room;                                         // around the mean of its masses at rest
  bool smooth = false;                               // grown by a network: drawn with a smooth skin
  std::array<bool, max_materials> materials{};       // ids of its springs' materials
};

std::shared_ptr<const RobotShape> shape_of(const Robot& robot);
// All of them together, for a renderer.
std::shared_ptr<const render::BodyData> bodies_of(std::span<const std::shared_ptr<const RobotShape>> shapes);

}  // namespace mercury
