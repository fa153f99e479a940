// SPDX-License-Identifier: Apache-2.0
// Numbers to colour robots by: what they are at a moment, and the scale that turns them into colours.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mercury/simulation.h"
#include "render/scene.h"

namespace mercury {

enum class ColorBy {
  material,    // each material's own colour
  activation,  // contraction of the muscle, (L0 - L(t)) / L0 [%]
  strain,      // (|d| - L0) / L0 [%]
  force,       // of a spring, positive = it pulls its ends together [N]
  speed,       // of a mass [m/s]
  pressure,    // of the water on a face, |F| / A [Pa]
  energy,      // elastic, of a spring, k (|d| - L)^2 / 2 [mJ]
  stiffness,   // of a spring, times the environment's scale [N/m]
};

// "material", ..., "stiffness".
std::string_view name_of(ColorBy by);
// Throws InputError("--color: ...") that lists them.
ColorBy color_named(std::string_view name);

// What can be said about a group at a moment from its positions and velocities; computed on all cores.
struct GroupState {
  double time = 0;              // [s]
  std::vector<Vec3> positions;  // of all masses, as Simulation::read_positions
  std::vector<Vec3> velocities;
};
GroupState read_state(const Simulation& simulation);

// One element a face, mass and spring of all robots; empty where the quantity has none.
struct ColorValues {
  std::vector<float> face, mass, spring;
};

// Computes the values of one quantity. Refers to the simulation, whose robots must not change meanwhile.
class Coloring {
 public:
  // Throws InputError("--color: ...") if the environment knows no such quantity.
  Coloring(const Simulation& simulation, ColorBy by);

  ColorBy by() const { return by_; }
  // Nothing for ColorBy::material.
  ColorValues values(const GroupState& state) const;

 private:
  void fill(ColorValues& values, std::size_t robot, const GroupState& state) const;

  const Simulation& simulation_;
  ColorBy by_;
  std::vector<std::vector<MaterialId>> face_materials_;  // for activation, a robot
  std::vector<std::size_t> face_offsets_, spring_offsets_;
};

// A scale that fits the values of a film so far. It only grows, by steps of 1, 2 and 5, so that colours hardly ever
// change their meaning; or it is fixed by the user.
class GrowingScale {
 public:
  GrowingScale(ColorBy by, std::optional<std::pair<float, float>> fixed);
  void fit(const ColorValues& values);
  const render::Scale& scale() const { return scale_; }
  // Title and unit of the quantity, with the scale.
  render::Legend legend() const;

 private:
  ColorBy by_;
  bool fixed_;
  render::Scale scale_;
};

// The smallest of 1, 2, 5 times a power of ten that is not below `value`; `value` > 0.
float round_up(float value);

}  // namespace mercury
