// SPDX-License-Identifier: Apache-2.0
#include "app/live/scene_parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/live/scene_core.h"
#include "mercury/brain.h"
#include "mercury/error.h"

namespace mercury {

bool SceneParameters::set_configuration(const Configuration& configuration) {
  Configuration wanted = configuration;
  wanted.device = core_.document().configuration.device;
  if (wanted == core_.document().configuration) return true;
  try {
    validate(wanted);
  } catch (const InputError& error) {
    core_.report(Severity::warning, error.what());
    return false;
  }
  const bool moves = !same_parts(wanted.environment, core_.document().configuration.environment);
  SceneDocument& document = moves ? core_.edit(fmt::format("move to {}", name_of(wanted.environment)))
                                  : core_.edit("change parameters", "parameters");
  if (moves) document.surroundings = core_.new_surroundings();
  document.configuration = wanted;
  core_.apply_document();
  if (!document.attachments.empty()) core_.perturbations().send();
  return true;
}

bool SceneParameters::set_start(const TrialStart& start) {
  if (start == core_.document().start) return true;
  try {
    validate(start.trials);
  } catch (const InputError& error) {
    core_.report(Severity::warning, error.what());
    return false;
  }
  core_.edit("change the start", "start").start = start;
  core_.apply_document();
  core_.follow_start();
  return true;
}

bool SceneParameters::push(const Vec3& velocity) {
  constexpr double reaction = 0.1;  // physics has carried the change out by then [s]
  core_.history().end_edit();
  Configuration configuration = core_.document().configuration;
  configuration.environment.push = velocity;
  configuration.environment.push_at =
      static_cast<float>(core_.snapshot().time + configuration.dt + reaction * core_.snapshot().achieved_speed);
  const bool accepted = set_configuration(configuration);
  core_.history().end_edit();
  return accepted;
}

std::span<const Material> SceneParameters::materials(RobotId robot) const {
  const DocumentRobot* found = core_.document().find(robot);
  return found ? materials_of(found->body) : std::span<const Material>{};
}

bool SceneParameters::set_material(const std::vector<RobotId>& robots, MaterialId id, const Material& material) {
  try {
    validate(material, "material " + std::to_string(id));
  } catch (const InputError& error) {
    core_.report(Severity::warning, error.what());
    return false;
  }
  core_.change_robots(robots, "change a material", fmt::format("material {}", id), [&](DocumentRobot& robot) {
    const auto now = materials_of(robot.body);
    if (id == air || id >= now.size() || now[id] == material) return false;
    auto table = std::make_shared<std::vector<Material>>(now.begin(), now.end());
    (*table)[id] = material;
    robot.body.materials = std::move(table);
    return true;
  });
  return true;
}

bool SceneParameters::scale_materials(const std::vector<RobotId>& robots, const MaterialScale& scale) {
  if (!std::isfinite(scale.stiffness) || scale.stiffness < 0 || !std::isfinite(scale.amplitude) ||
      !std::isfinite(scale.frequency) || !std::isfinite(scale.phase)) {
    core_.report(Severity::warning, "materials: give finite factors, and at least 0 for the stiffness");
    return false;
  }
  core_.change_robots(robots, "tune materials", "materials", [&](DocumentRobot& robot) {
    const auto own = materials_of(*robot.body.robot);
    auto table = std::make_shared<std::vector<Material>>(own.begin(), own.end());
    for (std::size_t id = 1; id < table->size(); ++id) {
      Material& material = (*table)[id];
      material.stiffness = std::min(material.stiffness * scale.stiffness, 1e30f);
      material.amplitude = std::clamp(material.amplitude * scale.amplitude, -0.99f, 0.99f);
      material.frequency *= scale.frequency;
      if (material.amplitude != 0) material.phase += scale.phase;
    }
    if (!std::ranges::all_of(*table, [](const Material& material) { return is_valid(material); })) return false;
    if (std::ranges::equal(*table, materials_of(robot.body))) return false;
    robot.body.materials = std::ranges::equal(*table, own) ? nullptr : std::move(table);
    return true;
  });
  return true;
}

void SceneParameters::reset_materials(const std::vector<RobotId>& robots) {
  core_.history().end_edit();
  core_.change_robots(robots, "reset materials", {}, [](DocumentRobot& robot) {
    const bool tuned = robot.body.materials != nullptr;
    robot.body.materials.reset();
    return tuned;
  });
}

void SceneParameters::drive_actuator(const std::vector<RobotId>& robots, const std::string& name,
                                     std::optional<float> drive) {
  if (drive) drive = std::clamp(*drive, -1.0f, 1.0f);
  core_.change_robots(robots, drive ? "drive an actuator" : "release an actuator", "drive " + name,
                      [&](DocumentRobot& robot) {
                        const std::vector<Actuator> actuators = actuators_of(*robot.body.robot);
                        const auto found = std::ranges::find(actuators, name, &Actuator::name);
                        if (found == actuators.end()) return false;
                        return hold(robot.body, &ByHand::drives, actuators.size(),
                                    static_cast<std::size_t>(found - actuators.begin()), drive);
                      });
}

void SceneParameters::release_actuators(const std::vector<RobotId>& robots) {
  core_.history().end_edit();
  core_.change_robots(robots, "release actuators", {},
                      [](DocumentRobot& robot) { return release(robot.body, &ByHand::drives); });
}

void SceneParameters::clamp_neuron(RobotId robot, std::size_t neuron, std::optional<float> value) {
  core_.change_robots(
      {robot}, value ? "hold a neuron" : "release a neuron", fmt::format("neuron {}", neuron), [&](DocumentRobot& one) {
        const std::size_t count = one.body.robot->brain ? brain_layout(*one.body.robot).neurons.size() : 0;
        return neuron < count && hold(one.body, &ByHand::neurons, count, neuron, value);
      });
}

void SceneParameters::release_neurons(RobotId robot) {
  core_.history().end_edit();
  core_.change_robots({robot}, "release neurons", {},
                      [](DocumentRobot& one) { return release(one.body, &ByHand::neurons); });
}

}  // namespace mercury
