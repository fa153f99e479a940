// SPDX-License-Identifier: Apache-2.0
// What a program may change between steps of a Simulation: materials, brains and perturbations.
#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string>

#include "mercury/error.h"
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

const Environment& Simulation::environment(std::size_t robot) const {
  parts_->require(robot);
  const std::optional<Environment>& own = parts_->environments[robot];
  return own ? *own : parts_->configuration.environment;
}

namespace {

// What may not differ between an environment of a robot and that of the batch.
void require_shared_parts(const Environment& own, const Environment& shared, const Robot& robot) {
  if (!same_parts(own, shared))
    throw InputError("environment", "a robot's own environment needs the parts of " + std::string(name_of(shared)) +
                                        ", not those of " + std::string(name_of(own)));
  Environment rest = own;
  rest.water = shared.water;
  rest.ground = shared.ground;
  rest.gravity = shared.gravity;
  for_each_parameter_pair(rest, shared, [](const auto& parameter, const auto& part, const auto& shared_part) {
    if (part.*parameter.member != shared_part.*parameter.member)
      throw InputError(std::string(parameter.name), "is the same for all robots; gravity, water and ground may differ");
  });
  if (flow_of(own) != flow_of(shared) &&
      std::ranges::any_of(robot.sensors, [](const Sensor& sensor) { return sensor.kind == SensorKind::flow; }))
    throw InputError("flow", "robot " + robot.name + " senses the flow, which is then the same for all robots");
}

}  // namespace

void Simulation::set_environments(std::span<const std::size_t> robots, std::span<const Environment> environments) {
  if (robots.size() != environments.size()) throw std::invalid_argument("an environment per robot is needed");
  std::vector<bool> given(size());
  for (std::size_t i = 0; i < robots.size(); ++i) {
    parts_->require(robots[i]);
    if (given[robots[i]]) throw std::invalid_argument("a robot can have only one environment");
    given[robots[i]] = true;
    Configuration own = parts_->configuration;
    own.environment = environments[i];
    validate(own);
    require_shared_parts(environments[i], parts_->configuration.environment, robot(robots[i]));
  }
  for (std::size_t i = 0; i < robots.size(); ++i) parts_->environments[robots[i]] = environments[i];
  parts_->backend->set_environments(robots, environments);
}

void Simulation::Parts::write_environments() {
  std::vector<std::size_t> own;
  std::vector<Environment> values;
  for (std::size_t i = 0; i < size(); ++i)
    if (environments[i]) {
      own.push_back(i);
      values.push_back(*environments[i]);
    }
  if (!own.empty()) backend->set_environments(own, values);
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
  parts_->brains.begin_access();
  return parts_->brains.state(robot);
}

std::vector<BrainState> Simulation::brain_states() const {
  parts_->brains.begin_access();
  std::vector<BrainState> states;
  for (std::size_t i = 0; i < size(); ++i) states.push_back(parts_->brains.state(i));
  return states;
}

void Simulation::read_brains(std::span<float> senses, std::span<float> neurons) const {
  parts_->brains.begin_access();
  parts_->brains.read(senses, neurons);
}

const BrainArrays& Simulation::shared_brains() {
  parts_->host_thinks();  // asks the backend first
  return parts_->brains.share(*parts_->backend);
}

void Simulation::set_brain_state(std::size_t robot, const BrainState& state) {
  parts_->require(robot);
  parts_->change_brains([&](Brains& brains) { brains.set_state(robot, state); });
}

void Simulation::set_brain_weights(std::size_t robot, std::span<const float> weights) {
  parts_->require(robot);
  parts_->change_brains([&](Brains& brains) { brains.set_weights(robot, weights); });
}

void Simulation::clamp_neuron(std::size_t robot, std::size_t neuron, std::optional<float> value) {
  parts_->require(robot);
  parts_->change_brains([&](Brains& brains) { brains.clamp(robot, neuron, value); });
}

void Simulation::set_target(std::size_t robot, std::optional<Vec3> target) {
  parts_->require(robot);
  parts_->change_brains([&](Brains& brains) { brains.set_target(robot, target); });
}

void Simulation::set_noise_seed(std::size_t robot, std::uint64_t seed) {
  parts_->require(robot);
  parts_->change_brains([&](Brains& brains) { brains.set_noise_seed(robot, seed); });
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
