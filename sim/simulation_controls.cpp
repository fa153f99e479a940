// SPDX-License-Identifier: Apache-2.0
// What a program may change between steps of a Simulation: materials and perturbations.
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

Material Simulation::material(std::size_t robot, MaterialId id) const {
  parts_->require_material(robot, id);
  return parts_->table(robot)[id];
}

void Simulation::set_material(std::size_t robot, MaterialId id, const Material& material) {
  parts_->require_material(robot, id);
  validate(material, "material " + std::to_string(id));
  parts_->table(robot)[id] = material;
  parts_->backend->write_materials(robot, parts_->table(robot));
}

void Simulation::set_materials(std::span<const Material> tables) {
  if (tables.size() != size() * max_materials)
    throw std::invalid_argument("a table of 256 materials per robot is needed");
  // Names of places are made only where they are needed: a batch has a million materials.
  for (std::size_t i = 0; i < tables.size(); ++i)
    if (!is_valid(tables[i]))
      validate(tables[i],
               "robot " + std::to_string(i / max_materials) + ", material " + std::to_string(i % max_materials));
  std::ranges::copy(tables, parts_->materials.begin());
  parts_->backend->write_materials(parts_->materials);
}

std::vector<Material> Simulation::materials() const { return parts_->materials; }

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
