// SPDX-License-Identifier: Apache-2.0
#include "app/live/explosions.h"

#include <algorithm>

#include "app/scene/group_layout.h"

namespace mercury {
namespace {

// A spring may have become many times as long as its robot. Then shows the place where the robot was.
render::Bounds surroundings_of(const CulpritSpring& spring, const render::Bounds& rest) {
  constexpr float most = 12;  // of the robot's size
  const float size = std::max(2 * rest.radius(), 1e-3f);
  render::Bounds box;
  for (const render::Vector3& end : {spring.at_a, spring.at_b})
    if ((end - rest.center()).norm() < most * size) box.extend(end);
  if (box.empty()) box = rest;
  box.low -= render::Vector3::all(0.3f * size);
  box.high += render::Vector3::all(0.3f * size);
  return box;
}

std::optional<CulpritSpring> culprit_spring_of(const Snapshot& snapshot, std::size_t index,
                                               const render::Vector3& offset, const render::Bounds& box) {
  const Robot& robot = *snapshot.robots->robots[index].robot;
  const std::uint32_t spring_index = snapshot.telemetry[index].culprit_spring;
  if (spring_index >= robot.springs.size()) return std::nullopt;
  const Spring& spring = robot.springs[spring_index];
  const auto positions = snapshot.positions_of(index);
  CulpritSpring found{.index = spring_index,
                      .a = spring.a,
                      .b = spring.b,
                      .at_a = render::Vector3(positions[spring.a]) + offset,
                      .at_b = render::Vector3(positions[spring.b]) + offset,
                      .figures = spring_details(snapshot, index, spring_index),
                      .surroundings = {}};
  if (!found.at_a.is_finite() || !found.at_b.is_finite()) return std::nullopt;
  found.surroundings = surroundings_of(found, box);
  return found;
}

}  // namespace

std::vector<ExplodedRobot> exploded_robots(const Snapshot& snapshot, std::span<const render::Vector3> offsets,
                                           std::span<const render::Bounds> boxes) {
  std::vector<ExplodedRobot> exploded;
  for (std::size_t i = 0; i < std::min(snapshot.robots->size(), offsets.size()); ++i) {
    const Telemetry& telemetry = snapshot.telemetry[i];
    if (!telemetry.exploded) continue;
    const LiveRobot& robot = snapshot.robots->robots[i];
    const render::Bounds box = i < boxes.size() ? boxes[i] : rest_bounds(*robot.robot).moved(offsets[i]);
    exploded.push_back(
        {robot.id, i, robot.name, telemetry.exploded_at, culprit_spring_of(snapshot, i, offsets[i], box)});
  }
  std::ranges::stable_sort(exploded, {}, &ExplodedRobot::time);
  return exploded;
}

}  // namespace mercury
