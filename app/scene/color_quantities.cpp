// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <vector>

#include "app/scene/color_quantity.h"
#include "mercury/error.h"
#include "mercury/observables.h"

namespace mercury {
namespace {

// |d| - L(t) [m]
float stretch_of(const RobotState& state, const Spring& spring) {
  return stretch(spring, state.materials[spring.material], state.positions);
}

// (L0 - L(t)) / L0 [%]
float contraction(const MaterialNow& material) { return 100 * (1 - material.length_factor); }

float activation_of_spring(const RobotState& state, const Spring& spring) {
  return contraction(state.materials[spring.material]);
}

float activation_of_face(const RobotState& state, std::size_t face) {
  return contraction(state.materials[state.face_materials[face]]);
}

// (|d| - L0) / L0 [%]
float strain_percent(const RobotState& state, const Spring& spring) {
  return 100 * strain(spring_length(spring, state.positions), spring.rest_length);
}

// Hooke's law [N]; positive = the spring pulls its ends together.
float force(const RobotState& state, const Spring& spring) {
  return spring_force(state.materials[spring.material].stiffness, stretch_of(state, spring));
}

float speed(const RobotState& state, std::size_t mass) { return length(state.velocities[mass]); }

// Of the water on a face, |F| / A [Pa].
float pressure(const RobotState& state, std::size_t face) {
  const FaceForce force = face_force(state.environment, state.robot.faces[face], state.positions, state.velocities,
                                     state.behind_faces[face]);
  return force.area > 0 ? length(force.drag + force.lift) / force.area : 0;
}

// Elastic, k (|d| - L)^2 / 2 [mJ]
float energy(const RobotState& state, const Spring& spring) {
  return 1000 * elastic_energy(state.materials[spring.material].stiffness, stretch_of(state, spring));
}

// Times the environment's scale [N/m].
float stiffness(const RobotState& state, const Spring& spring) { return state.materials[spring.material].stiffness; }

// Power of the muscle [W]: the rate at which it does work on the body by changing its rest length L.
//
//   elastic energy               E  = k (|d| - L)^2 / 2
//   tension                      T  = k (|d| - L)              positive = the spring pulls its ends together
//   change of the energy         E' = T |d|' - T L'
//   power that the masses get    M  = -T |d|'
//   power that the muscle gives  P  = E' + M = -T L'
//
// Positive = the muscle does work on the body: it shortens while it pulls, or lengthens while it pushes. Negative = the
// body does work on the muscle. Without damping and environment, the powers of all springs add up to the change of
// kinetic plus elastic energy.
float power(const RobotState& state, const Spring& spring) {
  return muscle_power(spring, state.materials[spring.material], stretch_of(state, spring));
}

constexpr std::array quantities{
    ColorQuantity{.key = "material",
                  .name = "Material",
                  .unit = "",
                  .help = "each material's own color; muscles glow as they contract"},
    ColorQuantity{.key = "activation",
                  .name = "Activation",
                  .unit = "%",
                  .help = "how far the muscles are contracted",
                  .map = render::Colormap::diverging,
                  .is_signed = true,
                  .of_spring = activation_of_spring,
                  .of_face = activation_of_face},
    ColorQuantity{.key = "strain",
                  .name = "Strain",
                  .unit = "%",
                  .help = "how far springs are stretched (red) or pressed together (blue)",
                  .map = render::Colormap::diverging,
                  .is_signed = true,
                  .of_spring = strain_percent},
    ColorQuantity{.key = "force",
                  .name = "Force",
                  .unit = "N",
                  .help = "force of the springs: pulling (red) or pushing (blue)",
                  .map = render::Colormap::diverging,
                  .is_signed = true,
                  .smallest_end = 0.01f,
                  .of_spring = force},
    ColorQuantity{.key = "speed",
                  .name = "Speed",
                  .unit = "m/s",
                  .help = "speed of the masses",
                  .smallest_end = 0.001f,
                  .of_mass = speed},
    ColorQuantity{.key = "pressure",
                  .name = "Pressure",
                  .unit = "Pa",
                  .help = "pressure of the water on the skin",
                  .map = render::Colormap::turbo,
                  .smallest_end = 0.001f,
                  .of_face = pressure,
                  .has = has_face_forces,
                  .requirement = "drag on faces"},
    ColorQuantity{.key = "energy",
                  .name = "Energy",
                  .unit = "mJ",
                  .help = "elastic energy of the springs",
                  .smallest_end = 0.01f,
                  .of_spring = energy},
    ColorQuantity{.key = "stiffness",
                  .name = "Stiffness",
                  .unit = "N/m",
                  .help = "stiffness of the springs",
                  .of_spring = stiffness},
    ColorQuantity{.key = "power",
                  .name = "Power",
                  .unit = "W",
                  .help = "power of the muscles: they do work on the body (red) or the body on them (blue)",
                  .map = render::Colormap::diverging,
                  .is_signed = true,
                  .smallest_end = 0.001f,
                  .of_spring = power},
};

}  // namespace

std::span<const ColorQuantity> color_quantities() { return quantities; }

const ColorQuantity& color_quantity(std::string_view key) {
  std::vector<std::string_view> keys;
  for (const ColorQuantity& quantity : quantities) {
    if (quantity.key == key) return quantity;
    keys.push_back(quantity.key);
  }
  throw ParameterError("color", fmt::format("\"{}\" is not accepted; give {}", key, fmt::join(keys, ", ")));
}

std::string environments_of(const ColorQuantity& quantity) {
  if (!quantity.has) return "";
  std::vector<std::string_view> names;
  for (const EnvironmentPreset& preset : environment_presets)
    if (quantity.exists_in(preset.environment)) names.push_back(preset.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace mercury
