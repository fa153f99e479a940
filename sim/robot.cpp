// SPDX-License-Identifier: Apache-2.0
#include "mercury/robot.h"

#include <algorithm>
#include <cmath>

#include "mercury/error.h"
#include "mercury/fnv.h"
#include "sim/actuators.h"
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

}  // namespace

std::span<const Material> materials_of(const Robot& robot) {
  return robot.materials.empty() ? default_materials() : std::span<const Material>(robot.materials);
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
}

}  // namespace mercury
