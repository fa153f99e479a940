// SPDX-License-Identifier: Apache-2.0
#include "robots/carried_points.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>

#include "mercury/error.h"

namespace mercury {

MassPlace mass_place_of(Vec3 rest) {
  const auto step = [](float x) { return std::llround(static_cast<double>(x) / (0.25 * min_rest_length)); };
  return {step(rest.x), step(rest.y), step(rest.z)};
}

void carry_brain(const Robot& from, Robot& to) {
  if (from.sensors.empty() && !from.brain) return;
  const bool by_index = std::ranges::any_of(
      from.sensors, [](const Sensor& sensor) { return !sensor.springs.empty() || !sensor.masses.empty(); });
  if (by_index && !same_topology(from, to)) return;
  to.sensors = from.sensors;
  to.brain = from.brain;
  try {
    validate_brain(to);
  } catch (const InputError&) {
    to.sensors.clear();
    to.brain.reset();
  }
}

void carry_control(const Robot& from, Robot& to) {
  const bool same_table =
      materials_of(to).size() == materials_of(from).size() && to.material_names == from.material_names;
  if (same_table) to.actuators = from.actuators;
  carry_brain(from, to);
}

void carry_points(const Robot& from, Robot& to) {
  if (from.mass.empty() && from.velocity.empty() && from.fixed.empty()) return;
  std::map<MassPlace, std::size_t> places;
  for (std::size_t i = 0; i < from.masses.size(); ++i) places.emplace(mass_place_of(from.masses[i]), i);
  std::vector<std::optional<std::size_t>> source(to.masses.size());
  for (std::size_t i = 0; i < source.size(); ++i)
    if (const auto found = places.find(mass_place_of(to.masses[i])); found != places.end()) source[i] = found->second;

  if (to.mass.empty() && !from.mass.empty()) {
    const double sum = std::accumulate(from.mass.begin(), from.mass.end(), 0.0);
    const auto mean = static_cast<float>(sum / static_cast<double>(from.mass.size()));
    for (const auto& point : source) to.mass.push_back(point ? from.mass[*point] : mean);
  }
  if (to.velocity.empty() && !from.velocity.empty())
    for (const auto& point : source) to.velocity.push_back(point ? from.velocity[*point] : Vec3{});
  if (to.fixed.empty() && !from.fixed.empty()) {
    std::vector<bool> fixed(from.masses.size());
    for (const std::uint16_t point : from.fixed) fixed[point] = true;
    for (std::size_t i = 0; i < source.size(); ++i)
      if (source[i] && fixed[*source[i]]) to.fixed.push_back(static_cast<std::uint16_t>(i));
  }
}

}  // namespace mercury
