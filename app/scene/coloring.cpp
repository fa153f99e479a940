// SPDX-License-Identifier: Apache-2.0
#include "app/scene/coloring.h"

#include <fmt/format.h>

#include "app/scene/appearance.h"
#include "mercury/error.h"
#include "mercury/parallel.h"

namespace mercury {
namespace {

// Each mass takes the mean of its springs; 0 without one.
void average_to_masses(const Robot& robot, std::span<const float> spring, std::span<float> mass) {
  std::vector<int> counts(robot.masses.size(), 0);
  for (std::size_t i = 0; i < robot.springs.size(); ++i)
    for (const std::uint16_t end : {robot.springs[i].a, robot.springs[i].b}) {
      mass[end] += spring[i];
      ++counts[end];
    }
  for (std::size_t i = 0; i < counts.size(); ++i)
    if (counts[i] > 0) mass[i] /= static_cast<float>(counts[i]);
}

// Masses need the mean of their springs only where nothing else colors the skin.
bool averages_springs(const ColorQuantity& quantity) {
  return quantity.of_spring && !quantity.of_mass && !quantity.of_face;
}

}  // namespace

Coloring::Coloring(const Simulation& simulation, const ColorQuantity& quantity)
    : simulation_(simulation), quantity_(quantity) {
  const Environment& environment = simulation.configuration().environment;
  if (!quantity.exists_in(environment))
    throw ParameterError("color", fmt::format("{}: {} has no {}; it applies to {}", quantity.key, name_of(environment),
                                              quantity.requirement, environments_of(quantity)));
  face_offsets_.push_back(0);
  spring_offsets_.push_back(0);
  for (std::size_t i = 0; i < simulation.size(); ++i) {
    const Robot& robot = simulation.robot(i);
    face_offsets_.push_back(face_offsets_.back() + robot.faces.size());
    spring_offsets_.push_back(spring_offsets_.back() + robot.springs.size());
    face_materials_.push_back(quantity.of_face ? face_materials(robot) : std::vector<MaterialId>());
  }
}

ColorValues Coloring::values(const GroupState& state) const {
  ColorValues values;
  if (quantity_.of_face) values.face.resize(face_offsets_.back());
  if (quantity_.of_spring) values.spring.resize(spring_offsets_.back());
  if (quantity_.of_mass || averages_springs(quantity_)) values.mass.resize(state.positions.size());
  parallel_for(0, simulation_.size(), [&](std::size_t i) { fill(values, i, state); });
  return values;
}

void Coloring::fill(ColorValues& values, std::size_t index, const GroupState& state) const {
  const Robot& robot = simulation_.robot(index);
  const std::size_t first_mass = simulation_.mass_offsets()[index];
  const Environment& environment = simulation_.configuration().environment;
  const std::vector<Material> table = materials_of(simulation_, index);
  const std::vector<MaterialNow> materials = materials_at(simulation_, index, state);
  const std::vector<std::uint16_t> behind =
      quantity_.of_face ? masses_behind_faces(robot, environment) : std::vector<std::uint16_t>();
  const RobotState robot_state{
      .robot = robot,
      .environment = environment,
      .time = state.time,
      .positions = masses_of(simulation_, index, state.positions),
      .velocities = masses_of(simulation_, index, state.velocities),
      .material_table = table,
      .materials = materials,
      .face_materials = face_materials_[index],
      .behind_faces = behind,
  };
  const auto part = [](std::vector<float>& all, std::size_t first, std::size_t count) {
    return all.empty() ? std::span<float>() : std::span(all).subspan(first, count);
  };
  const auto face = part(values.face, face_offsets_[index], robot.faces.size());
  const auto mass = part(values.mass, first_mass, robot.masses.size());
  const auto spring = part(values.spring, spring_offsets_[index], robot.springs.size());

  for (std::size_t i = 0; i < spring.size(); ++i) spring[i] = quantity_.of_spring(robot_state, robot.springs[i]);
  for (std::size_t i = 0; i < face.size(); ++i) face[i] = quantity_.of_face(robot_state, i);
  if (quantity_.of_mass)
    for (std::size_t i = 0; i < mass.size(); ++i) mass[i] = quantity_.of_mass(robot_state, i);
  else if (!mass.empty())
    average_to_masses(robot, spring, mass);
}

}  // namespace mercury
