// SPDX-License-Identifier: Apache-2.0
// Measures of a robot: sizes, materials, and whether its skin is closed. `mercury info` prints them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "mercury/material.h"
#include "mercury/robot.h"

namespace mercury {

struct MaterialUse {
  MaterialId id = 0;
  std::string name;  // of the robot's own table, else of the default material, else "material 7"
  Material material;
  std::size_t springs = 0;  // made of this material
};

struct ActuatorUse {
  Actuator actuator;
  std::size_t springs = 0;  // made of its materials
};

struct Inspection {
  std::size_t masses = 0, springs = 0, faces = 0;
  std::vector<MaterialUse> materials;  // those with at least one spring, by id
  std::size_t muscles = 0;             // springs with an amplitude other than 0
  std::vector<ActuatorUse> actuators;  // actuators_of()

  Vec3 lowest, highest;                           // corners of the box around the masses at rest [m]
  Vec3 extent;                                    // sides of that box [m]
  float length = 0;                               // the longest side [m]
  float shortest_spring = 0, longest_spring = 0;  // rest lengths [m]
  double springs_a_mass = 0;                      // mean number of springs at a mass
  std::size_t components = 0;                     // parts that springs do not join to each other
  std::size_t loose_masses = 0;                   // masses without a spring

  // The skin. It is closed if it has faces and, at each edge, as many faces run one way as the other. Then it encloses
  // a volume, and its faces are oriented alike.
  bool closed = false;
  std::size_t open_edges = 0;     // edges where more faces run one way than the other
  std::size_t crowded_edges = 0;  // edges shared by more than two faces
  long euler_characteristic = 0;  // of the skin: masses - edges + faces; 2 for a ball, 0 for a ring
  double area = 0;                // [m2]
  double volume = 0;              // enclosed, by the divergence theorem; negative if the skin is inside out [m3]
};

// Measures a robot, which must be valid (see validate in robot.h).
Inspection inspect(const Robot& robot);

// FNV-1a over masses, springs, faces, materials, velocities and fixed points, bit for bit. Equal robots have equal
// hashes, whatever their names, their origins and the names of their materials; the default table is as good as a copy
// of it.
std::uint64_t body_hash(const Robot& robot);

}  // namespace mercury
