// SPDX-License-Identifier: Apache-2.0
// Measures of a robot: what `mercury info` tells about it.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "mercury/material.h"
#include "mercury/robot.h"

namespace mercury {

struct MaterialUse {
  MaterialId id = 0;
  std::string name;  // the robot's own, else that of the default material, else "material 7"
  Material material;
  std::size_t springs = 0;  // of this material
};

struct Inspection {
  std::size_t masses = 0, springs = 0, faces = 0;
  std::vector<MaterialUse> materials;  // those that a spring is of, by id
  std::size_t muscles = 0;             // springs whose length changes by itself

  Vec3 lowest, highest;                           // corners of the box around the masses at rest [m]
  Vec3 extent;                                    // of that box [m]
  float length = 0;                               // the largest of the three [m]
  float shortest_spring = 0, longest_spring = 0;  // rest lengths [m]
  double springs_a_mass = 0;                      // how many springs end at a mass, on average
  std::size_t components = 0;                     // parts that no spring joins
  std::size_t loose_masses = 0;                   // masses without a spring

  // The skin. Closed: there are faces, and at each edge as many run one way as the other, so that their half-edges
  // cancel and the skin encloses a volume, oriented alike.
  bool closed = false;
  std::size_t open_edges = 0;     // edges whose half-edges do not cancel
  std::size_t crowded_edges = 0;  // edges of more than two faces
  long euler_characteristic = 0;  // masses on the skin - its edges + its faces; 2 for a ball, 0 for a ring
  double area = 0;                // [m2]
  double volume = 0;              // enclosed, by the divergence theorem; below 0 if the skin is inside out [m3]
};

// The robot must be valid.
Inspection inspect(const Robot& robot);

}  // namespace mercury
