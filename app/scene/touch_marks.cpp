// SPDX-License-Identifier: Apache-2.0
#include "app/scene/touch_marks.h"

#include "mercury/brain.h"

namespace mercury {

namespace {

float mean_spring_length(const Robot& robot) {
  float sum = 0;
  for (const Spring& spring : robot.springs) sum += spring.rest_length;
  return robot.springs.empty() ? 0 : sum / static_cast<float>(robot.springs.size());
}

}  // namespace

TouchObserver::TouchObserver(const Simulation& simulation) {
  if (!has_ground(simulation.configuration().environment)) return;
  for (std::size_t i = 0; i < simulation.size(); ++i) {
    const Robot& robot = simulation.robot(i);
    for (const std::vector<std::uint16_t>& masses : touch_places(robot)) {
      Place& place = places_.emplace_back();
      place.robot = static_cast<std::uint32_t>(i);
      for (const std::uint16_t mass : masses) place.masses.push_back(simulation.mass_offsets()[i] + mass);
      place.radius = 0.5f * mean_spring_length(robot);
    }
  }
}

std::vector<TouchMark> TouchObserver::marks(std::span<const Vec3> positions,
                                            std::span<const Telemetry> telemetry) const {
  std::vector<TouchMark> marks;
  for (const Place& place : places_) {
    if (telemetry[place.robot].exploded) continue;
    const std::size_t first = marks.size();
    for (const std::size_t mass : place.masses)
      if (const Vec3 at = positions[mass]; at.z <= 0)
        marks.push_back({.body = place.robot, .center = {at.x, at.y, 0}, .radius = place.radius});
    const auto touching = static_cast<float>(marks.size() - first);
    for (TouchMark& mark : std::span(marks).subspan(first))
      mark.share = touching / static_cast<float>(place.masses.size());
  }
  return marks;
}

}  // namespace mercury
