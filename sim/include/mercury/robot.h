// SPDX-License-Identifier: Apache-2.0
// A robot as plain data: masses of 1 kg, springs that join them, and a skin of triangles (paper, II.A).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

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

struct Robot {
  std::string name;
  std::vector<Material> materials;          // by id; empty = the 254 default materials
  std::vector<std::string> material_names;  // one per material of `materials`, or empty
  std::vector<Vec3> masses;                 // positions at rest [m]
  std::vector<Spring> springs;
  std::vector<Face> faces;
  std::string origin;  // how the robot was made, as JSON text; empty = unknown
  friend bool operator==(const Robot&, const Robot&) = default;
};

// The robot's own materials, or the default materials. Refers to the robot.
std::span<const Material> materials_of(const Robot& robot);

// Distance of two masses at rest [m], the default of Spring::rest_length.
float rest_distance(const Robot& robot, std::uint16_t a, std::uint16_t b);

// Two robots have the same topology if their springs join the same masses and their faces have the same corners, in the
// same order. Materials, rest lengths and positions may differ. The keys of robots of the same topology are equal;
// other robots rarely have equal keys.
bool same_topology(const Robot& a, const Robot& b);
std::uint64_t topology_key(const Robot& robot);

// Throws InputError with the place as a JSON pointer ("/springs/7: mass 912 is out of range, the robot has 300") unless
// - there are 1 to max_masses masses, with finite positions within 1e6 m of the origin,
// - every spring joins two different masses, has a material of the table other than air, and a finite rest length of at
//   least min_rest_length,
// - every face has three different masses,
// - every material is valid.
void validate(const Robot& robot);

}  // namespace mercury
