// SPDX-License-Identifier: Apache-2.0
#include "mercury/robot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "mercury/error.h"
#include "mercury/fnv.h"
#include "sim/physics/integration.h"

namespace mercury {
namespace {

std::string place(const char* list, std::size_t index) { return std::string(list) + std::to_string(index); }

[[noreturn]] void refuse_mass(std::size_t mass, const Robot& robot, const std::string& where) {
  throw InputError(
      where, "mass " + std::to_string(mass) + " is out of range, the robot has " + std::to_string(robot.masses.size()));
}

void validate_masses(const Robot& robot) {
  if (robot.masses.empty()) throw InputError("/masses", "a robot needs at least one mass");
  if (robot.masses.size() > max_masses)
    throw InputError("/masses", std::to_string(robot.masses.size()) + " masses, at most 65535 are accepted");
  for (std::size_t i = 0; i < robot.masses.size(); ++i)
    if (!within_reach(robot.masses[i]))
      throw InputError(place("/masses/", i), "a position must be finite and within 1e6 m of the origin");
}

void validate_points(const Robot& robot) {
  const std::size_t points = robot.masses.size();
  const auto require_count = [&](std::size_t count, const char* where, const char* what) {
    if (count != 0 && count != points)
      throw InputError(where, std::to_string(count) + what + ", the robot has " + std::to_string(points) + " masses");
  };
  require_count(robot.mass.size(), "/mass", " numbers");
  for (std::size_t i = 0; i < robot.mass.size(); ++i)
    if (!(std::isfinite(robot.mass[i]) && robot.mass[i] > 0))
      throw InputError(place("/mass/", i), "a mass must be a finite number above 0 kg");
  require_count(robot.velocity.size(), "/velocity", " vectors");
  for (std::size_t i = 0; i < robot.velocity.size(); ++i)
    if (const Vec3 v = robot.velocity[i]; !(std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z)))
      throw InputError(place("/velocity/", i), "a velocity must be finite");
  std::vector<bool> seen(robot.fixed.empty() ? 0 : points);
  for (std::size_t i = 0; i < robot.fixed.size(); ++i) {
    const std::uint16_t point = robot.fixed[i];
    if (point >= points) refuse_mass(point, robot, place("/fixed/", i));
    if (seen[point]) throw InputError(place("/fixed/", i), "mass " + std::to_string(point) + " is listed twice");
    seen[point] = true;
  }
}

bool is_valid(const Spring& spring, std::size_t masses, std::size_t materials) {
  return spring.a < masses && spring.b < masses && spring.a != spring.b && spring.material != air &&
         spring.material < materials && spring.rest_length >= min_rest_length && spring.rest_length <= farthest;
}

// Says what is wrong with a spring that is not valid.
[[noreturn]] void refuse_spring(const Robot& robot, std::size_t index) {
  const Spring& spring = robot.springs[index];
  const std::string where = place("/springs/", index);
  for (const std::size_t mass : {spring.a, spring.b})
    if (mass >= robot.masses.size()) refuse_mass(mass, robot, where);
  if (spring.a == spring.b) throw InputError(where, "joins mass " + std::to_string(spring.a) + " to itself");
  if (spring.material == air) throw InputError(where, "material 0 is air, a spring needs another");
  if (const std::size_t materials = materials_of(robot).size(); spring.material >= materials)
    throw InputError(where, "material " + std::to_string(spring.material) + " is out of range, the table has " +
                                std::to_string(materials));
  throw InputError(where, "rest length " + std::to_string(spring.rest_length) + " m, at least 0.001 m is accepted");
}

bool is_valid(const Face& face, std::size_t masses) {
  return face.a < masses && face.b < masses && face.c < masses && face.a != face.b && face.b != face.c &&
         face.c != face.a;
}

// Says what is wrong with a face that is not valid.
[[noreturn]] void refuse_face(const Robot& robot, std::size_t index) {
  const Face& face = robot.faces[index];
  const std::string where = place("/faces/", index);
  for (const std::size_t mass : {face.a, face.b, face.c})
    if (mass >= robot.masses.size()) refuse_mass(mass, robot, where);
  throw InputError(where, "a face needs three different masses");
}

// Actuators: groups of springs that a program drives.

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

}  // namespace

std::span<const Material> materials_of(const Robot& robot) {
  return robot.materials.empty() ? default_materials() : std::span<const Material>(robot.materials);
}

std::string name_of_material(const Robot& robot, MaterialId id) {
  if (robot.materials.empty()) return default_material_name(id);
  if (robot.material_names.empty() || robot.material_names[id].empty()) return "material " + std::to_string(id);
  return robot.material_names[id];
}

float rest_distance(const Robot& robot, std::uint16_t a, std::uint16_t b) {
  return length(robot.masses[b] - robot.masses[a]);
}

bool same_topology(const Robot& a, const Robot& b) {
  const auto same_ends = [](const Spring& s, const Spring& t) { return s.a == t.a && s.b == t.b; };
  return a.masses.size() == b.masses.size() && std::ranges::equal(a.springs, b.springs, same_ends) &&
         a.faces == b.faces;
}

std::uint64_t topology_key(const Robot& robot) {
  Fnv1a key(Fnv1a::empty ^ robot.masses.size());
  for (const Spring& spring : robot.springs) key.step(std::uint64_t{spring.a} << 16 | spring.b);
  for (const Face& face : robot.faces) key.step(std::uint64_t{face.a} << 32 | std::uint64_t{face.b} << 16 | face.c);
  return key.value();
}

void validate(const Robot& robot) {
  if (robot.materials.size() > max_materials)
    throw InputError("/materials", std::to_string(robot.materials.size()) + " materials, at most 256 are accepted");
  if (!robot.material_names.empty() && robot.material_names.size() != robot.materials.size())
    throw InputError("/materials", "every material needs a name, or none");
  // The text of a place is made only where it is needed: a batch has millions of springs.
  for (std::size_t i = 0; i < robot.materials.size(); ++i)
    if (!is_valid(robot.materials[i])) validate(robot.materials[i], place("/materials/", i));
  validate_masses(robot);
  validate_points(robot);
  const std::size_t masses = robot.masses.size(), materials = materials_of(robot).size();
  for (std::size_t i = 0; i < robot.springs.size(); ++i)
    if (!is_valid(robot.springs[i], masses, materials)) refuse_spring(robot, i);
  for (std::size_t i = 0; i < robot.faces.size(); ++i)
    if (!is_valid(robot.faces[i], masses)) refuse_face(robot, i);
  validate_actuators(robot);
  validate_brain(robot);
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
