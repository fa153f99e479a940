// SPDX-License-Identifier: Apache-2.0
#include "app/scene/robot_shape.h"

#include "app/scene/appearance.h"
#include "app/scene/eigen_vec3.h"
#include "app/scene/group_layout.h"
#include "mercury/generator.h"

namespace mercury {

std::shared_ptr<const RobotShape> shape_of(const Robot& robot) {
  auto shape = std::make_shared<RobotShape>();
  shape->body = render::prepare_body(BodyShape(robot, 0).body());
  shape->box = rest_bounds(robot);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Vec3 mass : robot.masses) sum += eigen(mass).cast<double>();
  shape->center = (sum / static_cast<double>(robot.masses.size())).cast<float>();
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
