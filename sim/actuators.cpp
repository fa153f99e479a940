// SPDX-License-Identifier: Apache-2.0
// The actuators of a robot: groups of springs that a program drives (mercury/robot.h).
#include "sim/actuators.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "mercury/error.h"

namespace mercury {
namespace {

std::string name_of_material(const Robot& robot, MaterialId id) {
  if (robot.materials.empty()) return default_material_name(id);
  if (robot.material_names.empty() || robot.material_names[id].empty()) return "material " + std::to_string(id);
  return robot.material_names[id];
}

// Gives the robot a table of air and those materials that springs or actuators have.
void keep_used_materials(Robot& robot) {
  const std::span<const Material> defaults = default_materials();
  const bool had_defaults = robot.materials.empty();
  const std::vector<Material> table =
      had_defaults ? std::vector<Material>(defaults.begin(), defaults.end()) : std::exchange(robot.materials, {});
  const std::vector<std::string> names = std::exchange(robot.material_names, {});
  std::array<MaterialId, max_materials> new_id{};
  std::array<bool, max_materials> used{};
  for (const Spring& spring : robot.springs) used[spring.material] = true;
  for (const Actuator& actuator : robot.actuators)
    for (const MaterialId id : actuator.materials) used[id] = true;
  used[air] = true;
  for (std::size_t id = 0; id < table.size(); ++id) {
    if (!used[id]) continue;
    new_id[id] = static_cast<MaterialId>(robot.materials.size());
    robot.materials.push_back(table[id]);
    if (had_defaults) robot.material_names.push_back(default_material_name(static_cast<MaterialId>(id)));
    if (!names.empty()) robot.material_names.push_back(names[id]);
  }
  for (Spring& spring : robot.springs) spring.material = new_id[spring.material];
  for (Actuator& actuator : robot.actuators)
    for (MaterialId& id : actuator.materials) id = new_id[id];
}

// By material: whether one of the chosen springs has it, and whether another has.
struct MaterialUses {
  std::array<bool, max_materials> inside{}, outside{};

  MaterialUses(const Robot& robot, const std::vector<bool>& chosen) {
    for (std::size_t i = 0; i < chosen.size(); ++i) (chosen[i] ? inside : outside)[robot.springs[i].material] = true;
  }
  std::size_t shared() const {
    std::size_t count = 0;
    for (std::size_t id = 0; id < inside.size(); ++id) count += inside[id] && outside[id] ? 1 : 0;
    return count;
  }
};

// By index. Throws InputError.
std::vector<bool> chosen_springs(const Robot& robot, const std::string& actuator,
                                 std::span<const std::uint32_t> springs) {
  std::vector<bool> chosen(robot.springs.size());
  for (const std::uint32_t i : springs) {
    if (i >= chosen.size())
      throw InputError("actuator " + actuator, "spring " + std::to_string(i) + " is out of range, the robot has " +
                                                   std::to_string(chosen.size()));
    chosen[i] = true;
  }
  return chosen;
}

// Materials that only the chosen springs have: a copy of each that others have, too.
std::vector<MaterialId> give_own_materials(Robot& robot, const std::vector<bool>& chosen, const MaterialUses& uses) {
  std::vector<MaterialId> own;
  std::array<MaterialId, max_materials> new_id{};
  for (std::size_t id = 1; id < max_materials; ++id) {
    if (!uses.inside[id]) continue;
    new_id[id] = static_cast<MaterialId>(id);
    if (uses.outside[id]) {
      new_id[id] = static_cast<MaterialId>(robot.materials.size());
      robot.materials.push_back(robot.materials[id]);
      if (!robot.material_names.empty()) robot.material_names.push_back(robot.material_names[id]);
    }
    own.push_back(new_id[id]);
  }
  for (std::size_t i = 0; i < chosen.size(); ++i)
    if (chosen[i]) robot.springs[i].material = new_id[robot.springs[i].material];
  return own;
}

}  // namespace

void validate_actuators(const Robot& robot) {
  const std::size_t materials = materials_of(robot).size();
  std::array<bool, max_materials> taken{};
  for (std::size_t i = 0; i < robot.actuators.size(); ++i) {
    const Actuator& actuator = robot.actuators[i];
    const std::string where = "/actuators/" + std::to_string(i);
    if (actuator.name.empty() || actuator.name.find('\0') != std::string::npos)
      throw InputError(where, "an actuator needs a name, without NUL characters");
    for (std::size_t k = 0; k < i; ++k)
      if (robot.actuators[k].name == actuator.name)
        throw InputError(where, "has the name of actuator " + std::to_string(k));
    if (actuator.materials.empty()) throw InputError(where, "an actuator needs at least one material or spring");
    for (const MaterialId id : actuator.materials) {
      const std::string material = "material " + std::to_string(id);
      if (id == air) throw InputError(where, "material 0 is air, an actuator needs others");
      if (id >= materials)
        throw InputError(where, material + " is out of range, the table has " + std::to_string(materials));
      if (std::exchange(taken[id], true)) throw InputError(where, material + " is named twice among the actuators");
    }
  }
}

std::vector<Actuator> actuators_of(const Robot& robot) {
  if (!robot.actuators.empty()) return robot.actuators;
  const std::span<const Material> materials = materials_of(robot);
  std::array<bool, max_materials> used{};
  for (const Spring& spring : robot.springs) used[spring.material] = true;
  std::vector<Actuator> found;
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const auto id = static_cast<MaterialId>(i);
    if (!used[i] || materials[i].amplitude == 0) continue;
    const auto moves_alike = [&](const Actuator& actuator) {
      const Material& first = materials[actuator.materials.front()];
      return first.frequency == materials[i].frequency && first.phase == materials[i].phase &&
             first.half_wave == materials[i].half_wave;
    };
    const auto known = std::ranges::find_if(found, moves_alike);
    if (known != found.end())
      known->materials.push_back(id);
    else
      found.push_back({.name = name_of_material(robot, id), .materials = {id}});
  }
  return found;
}

void add_actuator(Robot& robot, const std::string& name, std::span<const std::uint32_t> springs) {
  Robot changed = robot;
  if (changed.materials.empty()) keep_used_materials(changed);
  const std::vector<bool> chosen = chosen_springs(changed, name, springs);
  std::array<bool, max_materials> driven{};
  for (const Actuator& actuator : changed.actuators)
    for (const MaterialId id : actuator.materials) driven[id] = true;
  MaterialUses uses(changed, chosen);
  for (std::size_t id = 1; id < max_materials; ++id)
    if (uses.inside[id] && driven[id])
      throw InputError("actuator " + name, "springs of material " + std::to_string(id) + " have an actuator already");
  if (changed.materials.size() + uses.shared() > max_materials) {
    keep_used_materials(changed);
    uses = MaterialUses(changed, chosen);
  }
  if (changed.materials.size() + uses.shared() > max_materials)
    throw InputError("actuator " + name, "needs more than 255 materials; a robot has at most 255 and air");
  changed.actuators.push_back({.name = name, .materials = give_own_materials(changed, chosen, uses)});
  validate_actuators(changed);
  robot = std::move(changed);
}

}  // namespace mercury
