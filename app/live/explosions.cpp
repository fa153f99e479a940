// SPDX-License-Identifier: Apache-2.0
#include "app/live/explosions.h"

#include <algorithm>

#include "app/scene/eigen_vec3.h"
#include "app/scene/group_layout.h"

namespace mercury {
namespace {

// A spring that has become many times as long as its robot is looked at where the robot was.
render::Bounds surroundings_of(const BadSpring& spring, const Robot& robot, const Eigen::Vector3f& offset) {
  constexpr float most = 12;  // of the robot's size
  const render::Bounds rest = rest_bounds(robot).moved(offset);
  const float size = std::max(2 * rest.radius(), 1e-3f);
  render::Bounds box;
  for (const Eigen::Vector3f& end : {spring.at_a, spring.at_b})
    if ((end - rest.center()).norm() < most * size) box.extend(end);
  if (box.empty()) box = rest;
  box.low.array() -= 0.3f * size;
  box.high.array() += 0.3f * size;
  return box;
}

std::optional<BadSpring> bad_spring_of(const Moment& moment, std::size_t index, const Eigen::Vector3f& offset) {
  const Robot& robot = *moment.robots->robots[index].robot;
  const std::uint32_t place = moment.telemetry[index].culprit_spring;
  if (place >= robot.springs.size()) return std::nullopt;
  const Spring& spring = robot.springs[place];
  const auto positions = moment.positions_of(index);
  BadSpring bad{.index = place,
                .a = spring.a,
                .b = spring.b,
                .at_a = eigen(positions[spring.a]) + offset,
                .at_b = eigen(positions[spring.b]) + offset,
                .figures = spring_figures(moment, index, place),
                .surroundings = {}};
  if (!bad.at_a.allFinite() || !bad.at_b.allFinite()) return std::nullopt;
  bad.surroundings = surroundings_of(bad, robot, offset);
  return bad;
}

}  // namespace

std::vector<ExplodedRobot> exploded_robots(const Moment& moment, std::span<const Eigen::Vector3f> offsets) {
  std::vector<ExplodedRobot> exploded;
  for (std::size_t i = 0; i < std::min(moment.robots->size(), offsets.size()); ++i) {
    const Telemetry& telemetry = moment.telemetry[i];
    if (!telemetry.exploded) continue;
    const LiveRobot& robot = moment.robots->robots[i];
    exploded.push_back({robot.id, i, robot.name, telemetry.exploded_at, bad_spring_of(moment, i, offsets[i])});
  }
  std::ranges::stable_sort(exploded, {}, &ExplodedRobot::time);
  return exploded;
}

}  // namespace mercury
