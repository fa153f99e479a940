// SPDX-License-Identifier: Apache-2.0
#include "app/scene/robot_shape.h"

#include "app/scene/appearance.h"
#include "mercury/generator.h"

namespace mercury {

std::shared_ptr<const RobotShape> shape_of(const Robot& robot) {
  auto shape = std::make_shared<RobotShape>();
  shape->body = render::prepare_body(BodyShape(robot, 0).body());
  shape->box = rest_bounds(robot);
  shape->room = room_of(robot);
  const Generator* generator = generator_of(robot);
  shape->smooth = generator && generator->smooth;
  for (const Spring& spring : robot.springs) shape->materials[spring.material] = true;
  return shape;
}

std::shared_ptr<const render::BodyData> bodies_of(std::span<const std::shared_ptr<const RobotShape>> shapes) {
  std::vector<std::shared_ptr<const render::PreparedBody>> bodies;
  for (const auto& shape : shapes) bodies.push_back(shape->body);
  return render::assemble(bodies);
}

}  // namespace mercury
