// SPDX-License-Identifier: Apache-2.0
// A robot as plain data: point masses, springs that join them, and a skin of triangles (paper, II.A).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mercury/brain.h"
#include "mercury/material.h"
#include "mercury/vec3.h"

namespace mercury {

struct Spring {
  std::uint16_t a = 0, b = 0;  // indices of masses
  MaterialId material = 0;
  float rest_length = 0;  // L0 [m], at least min_rest_length
  friend constexpr bool operator==(const Spring&, const Spring&) = default;
};

struct Face {
  std::uint16_t a = 0, b = 0, c = 0;  // indices of masses, counter-clockwise seen from outside
  friend constexpr bool operator==(const Face&, const Face&) = default;
};

inline constexpr float min_rest_length = 0.001f;         // [m] (paper, III.B)
inline constexpr std::size_t max_masses = 65535;         // mass indices have 16 bits
inline constexpr std::uint32_t no_spring = 0xffffffffu;  // stands for no index in Robot::springs

// Muscles that a program drives together (Simulation::actuation()): all springs of these materials.
struct Actuator {
  std::string name;
  std::vector<MaterialId> materials;
  friend bool operator==(const Actuator&, const Actuator&) = default;
};

struct Robot {
  std::string name;
  std::vector<Material> materials;          // by id; empty = the 254 default materials
  std::vector<std::string> material_names;  // one per material of `materials`, or empty
  std::vector<Vec3> masses;                 // positions at rest [m]
  std::vector<Spring> springs;
  std::vector<Face> faces;
  std::vector<float> mass;           // of each point [kg]; empty = 1 kg each, as in the paper
  std::vector<Vec3> velocity;        // of each point at the start [m/s]; empty = at rest
  std::vector<std::uint16_t> fixed;  // points that never move, each once
  std::string origin;                // how the robot was made, as JSON text; empty = unknown
  std::vector<Actuator> actuators;   // empty = those that actuators_of() finds
  std::vector<Sensor> sensors;
  std::optional<Brain> brain;  // drives actuators from what the sensors give
  std::string other;           // members of its file that this version does not know, a JSON object; empty = none
  friend bool operator==(const Robot&, const Robot&) = default;
};

// The mass of a point [kg].
inline float mass_of(const Robot& robot, std::size_t point) { return robot.mass.empty() ? 1.0f : robot.mass[point]; }

// The robot's own materials, or the default materials. Refers to the robot.
std::span<const Material> materials_of(const Robot& robot);
// Of a material of its table: its name there, or the default material's, or "material 3".
std::string name_of_material(const Robot& robot, MaterialId id);

// The actuators that a program drives: those that the robot names. If it names none, muscles that move alike belong to
// one actuator: those materials with an amplitude, of at least one spring, that have the same frequency, phase and half
// wave. Such actuators are in the order of their first material and have its name ("muscle 3"; "material 3" if it has
// none).
std::vector<Actuator> actuators_of(const Robot& robot);

// Makes an actuator of these springs, by their indices. Springs of an actuator need materials that no other springs
// have. So each of their materials is copied, unless no other spring has it. A robot with the default table, or one
// whose table has no room, gets a table of air and the materials that its springs have. Throws InputError if there is
// no such spring, if one of them has an actuator already, or if the table would have more than max_materials.
void add_actuator(Robot& robot, const std::string& name, std::span<const std::uint32_t> springs);

// Distance of two masses at rest [m], the default of Spring::rest_length.
float rest_distance(const Robot& robot, std::uint16_t a, std::uint16_t b);

// The volume within the skin at rest [m3]: negative if its faces show inward, 0 without a skin.
double skin_volume(const Robot& robot);

// Two robots have the same topology if their springs join the same masses and their faces have the same corners, in the
// same order. Materials, rest lengths and positions may differ. The keys of robots of the same topology are equal;
// other robots rarely have equal keys.
bool same_topology(const Robot& a, const Robot& b);
std::uint64_t topology_key(const Robot& robot);

// Throws InputError with the place as a JSON pointer ("/springs/7: mass 912 is out of range, the robot has 300") unless
// - there are 1 to max_masses masses, with finite positions within 1e6 m of the origin,
// - there are as many numbers in `mass` as points, or none, all finite and above zero,
// - there are as many velocities as points, or none, all finite,
// - every fixed point is one of the robot's, and is listed once,
// - every spring joins two different masses, has a material of the table other than air, and a finite rest length of at
//   least min_rest_length,
// - every face has three different masses,
// - every material is valid,
// - every actuator has a name of its own and at least one material, and no material belongs to two,
// - validate_brain() accepts its sensors and its brain.
void validate(const Robot& robot);

}  // namespace mercury
