// SPDX-License-Identifier: Apache-2.0
// The quantities that robots can be colored by. Each is described once, in the table of color_quantities.cpp; the
// command line, the window, the legend and the docs derive from it. A new quantity is one function and one entry there.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "mercury/configuration.h"
#include "mercury/observables.h"
#include "mercury/robot.h"
#include "mercury/vec3.h"
#include "render/colormap.h"

namespace mercury {

// One robot at one time: all that a quantity may depend on.
struct RobotState {
  const Robot& robot;
  const Environment& environment;
  double time;                                  // [s]
  std::span<const Vec3> positions;              // per mass [m]
  std::span<const Vec3> velocities;             // per mass [m/s]
  std::span<const Material> material_table;     // by material id, as the simulation has it now, without drives
  std::span<const MaterialNow> materials;       // the same at `time`, with what drives them
  std::span<const MaterialId> face_materials;   // per face, see face_materials()
  std::span<const std::uint16_t> behind_faces;  // per face, see masses_behind_faces()
};

// A quantity has at least one of the three functions, except "material", which has none: its colors are those of the
// materials themselves. Without `of_face` and `of_mass`, a mass takes the mean of its springs, and the skin takes the
// values of its masses.
struct ColorQuantity {
  std::string_view key;   // on the command line, in files and in the legend: "strain"
  std::string_view name;  // in the window: "Strain"
  std::string_view unit;  // of the values and the scale
  std::string_view help;  // one line, without a full stop
  render::Colormap map = render::Colormap::viridis;
  bool is_signed = false;  // the scale reaches from -high to high, else from 0
  float smallest_end = 1;  // the scale's `high` is never below this

  float (*of_spring)(const RobotState& state, const Spring& spring) = nullptr;
  float (*of_mass)(const RobotState& state, std::size_t mass) = nullptr;
  float (*of_face)(const RobotState& state, std::size_t face) = nullptr;

  // Whether an environment has this quantity; nullptr = every environment. `requirement` is what it must have.
  bool (*has)(const Environment& environment) = nullptr;
  std::string_view requirement;  // "drag on faces"

  bool has_values() const { return of_spring || of_mass || of_face; }
  bool exists_in(const Environment& environment) const { return !has || has(environment); }
};

// All quantities, "material" first, in the order of the window's buttons and number keys. They live as long as the
// program, and each is there once: compare them by address.
std::span<const ColorQuantity> color_quantities();

// The first of them: each material's own color.
inline const ColorQuantity& material_color() { return color_quantities().front(); }

// Throws ParameterError("color", ...) that lists all keys.
const ColorQuantity& color_quantity(std::string_view key);

// The environments that have a quantity: "ocean". Empty = all.
std::string environments_of(const ColorQuantity& quantity);

}  // namespace mercury
