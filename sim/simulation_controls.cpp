// SPDX-License-Identifier: Apache-2.0
// What a program may change between steps of a Simulation: materials, brains and perturbations.
#include <algorithm>
#include <stdexcept>
#include <string>

#include "mercury/simulation.h"
#include "sim/simulation_parts.h"

namespace mercury {

void Simulation::Parts::require_material(std::size_t robot, MaterialId id) const {
  require(robot);
  const std::size_t count = materials_of(*robots[robot]).size();
  if (id >= count)
    throw std::out_of_range("material " + std::to_string(id) + ", the robot has " + std::to_string(count));
}

MaterialTable Simulation::Parts::table(std::size_t robot) const {
  if (changed_tables[robot]) return *changed_tables[robot];
  MaterialTable table{};
  std::ranges::copy(materials_of(*robots[robot]), table.begin());
  return table;
}

Material Simulation::material(std::size_t robot, MaterialId id) const {
  parts_->require_material(robot, id);
  const auto& changed = parts_->changed_tables[robot];
  return changed ? (*changed)[id] : materials_of(*parts_->robots[robot])[id];
}

void Simulation::set_material(std::size_t robot, MaterialId id, const Material& material) {
  parts_->require_material(robot, id);
  validate(material, "material " + std::to_string(id));
  auto& changed = parts_->changed_tables[robot];
  if (!changed) changed = std::make_unique<MaterialTable>(parts_->table(robot));
  (*changed)[id] = material;
  parts_->backend->write_materials(robot, *changed);
  parts_->shared_actuation.materials_changed();
}

void Simulation::set_materials(std::span<const Material> tables) {
  if (tables.size() != size() * max_materials)
    throw std::invalid_argument("a table of 256 materials per robot is needed");
  // Names of places are made only where they are needed: a batch has a million materials.
  for (std::size_t i = 0; i < tables.size(); ++i)
    if (!is_valid(tables[i]))
      validate(tables[i],
               "robot " + std::to_string(i / max_materials) + ", material " + std::to_string(i % max_materials));
  for (std::size_t i = 0; i < size(); ++i) {
    auto& changed = parts_->changed_tables[i];
    if (!changed) changed = std::make_unique<MaterialTable>();
    std::ranges::copy(tables.subspan(i * max_materials, max_materials), changed->begin());
  }
  parts_->backend->write_materials(tables);
  parts_->shared_actuation.materials_changed();
}

std::vector<Material> Simulation::materials() const {
  std::vector<Material> all(size() * max_materials);
  for (std::size_t i = 0; i < size(); ++i)
    std::ranges::copy(parts_->table(i), all.begin() + static_cast<std::ptrdiff_t>(i * max_materials));
  return all;
}

bool Simulation::has_brains() const { return !parts_->brains.empty(); }

BrainState Simulation::brain_state(std::size_t robot) const {
  parts_->require(robot);
  return parts_->brains.state(robot);
}

void Simulation::set_brain_state(std::size_t robot, const BrainState& state) {
  parts_->require(robot);
  parts_->brains.set_state(robot, state);
}

void Simulation::set_brain_weights(std::size_t robot, std::span<const float> weights) {
  parts_->require(robot);
  parts_->brains.set_weights(robot, weights);
}

void Simulation::clamp_neuron(std::size_t robot, std::size_t neuron, std::optional<float> value) {
  parts_->require(robot);
  parts_->brains.clamp(robot, neuron, value);
}

void Simulation::set_target(std::size_t robot, std::optional<Vec3> target) {
  parts_->require(robot);
  parts_->brains.set_target(robot, target);
}

void Simulation::set_noise_seed(std::size_t robot, std::uint64_t seed) {
  parts_->require(robot);
  parts_->brains.set_noise_seed(robot, seed);
}

void Simulation::set_perturbations(std::span<const Perturbation> perturbations) {
  for (const Perturbation& perturbation : perturbations) {
    parts_->require(perturbation.robot);
    if (perturbation.mass >= parts_->masses(perturbation.robot))
      throw std::out_of_range("a perturbation of mass " + std::to_string(perturbation.mass) + ", the robot has " +
                              std::to_string(parts_->masses(perturbation.robot)));
  }
  parts_->backend->set_perturbations(perturbations);
}

}  // namespace mercury
