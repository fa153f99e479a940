// SPDX-License-Identifier: Apache-2.0
// The values of a color quantity for a whole group of robots.
#pragma once

#include <vector>

#include "app/scene/color_quantity.h"
#include "app/scene/group_state.h"
#include "mercury/simulation.h"

namespace mercury {

// One element per face, mass and spring of all robots, one robot after the other; empty where the quantity has none.
struct ColorValues {
  std::vector<float> face, mass, spring;
};

// Computes the values of one quantity on all cores. Refers to the simulation, whose robots must not change meanwhile.
class Coloring {
 public:
  // Throws ParameterError("color", ...) if the environment does not have the quantity.
  Coloring(const Simulation& simulation, const ColorQuantity& quantity);

  const ColorQuantity& quantity() const { return quantity_; }
  // Nothing for "material".
  ColorValues values(const GroupState& state) const;

 private:
  void fill(ColorValues& values, std::size_t robot, const GroupState& state) const;

  const Simulation& simulation_;
  const ColorQuantity& quantity_;
  std::vector<std::vector<MaterialId>> face_materials_;  // per robot
  std::vector<std::size_t> face_offsets_, spring_offsets_;
};

}  // namespace mercury
