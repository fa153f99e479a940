// SPDX-License-Identifier: Apache-2.0
// Configuration of a simulation: time step, solver, environment, device.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "mercury/parameters.h"
#include "mercury/vec3.h"

namespace mercury {

enum class Solver { force, xpbd };  // paper, Algorithm 1 and Algorithm 2

// An environment is a struct with a name, help, `gravity`, `stiffness_scale` and a table of its parameters, listed in
// Environment below; its equations are in sim/physics/environments.h.

// Water; drag and lift act on the faces (paper, equation 1).
struct Ocean {
  static constexpr std::string_view name = "ocean", help = "drag on the skin";
  float density = 1000;           // rho [kg/m3]
  float drag_coefficient = 1;     // C_D [1]
  float lift_coefficient = 0.2f;  // C_L [1]
  float drag_tangential = 0;      // C_T [1]
  Vec3 flow;                      // velocity of the water [m/s]
  Vec3 gravity;                   // [m/s2]
  float stiffness_scale = 1;      // multiplies every stiffness [1]
  friend bool operator==(const Ocean&, const Ocean&) = default;

  static constexpr std::tuple parameters{
      Parameter("density", &Ocean::density, "kg/m3", Accepts::at_least_zero, {0, 2000}, "Density of the water, rho"),
      Parameter("drag_coefficient", &Ocean::drag_coefficient, "", Accepts::at_least_zero, {0, 3},
                "Drag coefficient of a face across the flow, C_D"),
      Parameter("lift_coefficient", &Ocean::lift_coefficient, "", Accepts::at_least_zero, {0, 1},
                "Lift coefficient of a face, C_L"),
      Parameter("drag_tangential", &Ocean::drag_tangential, "", Accepts::at_least_zero, {0, 1},
                "Tangential drag coefficient of a face along the flow, C_T"),
      Parameter("flow", &Ocean::flow, "m/s", Accepts::any, {-2, 2}, "Velocity of the water"),
      Parameter("gravity", &Ocean::gravity, "m/s2", Accepts::any, {-20, 20}, "Gravity").or_downward_magnitude(),
      Parameter("stiffness_scale", &Ocean::stiffness_scale, "", Accepts::at_least_zero, {0.01f, 1000, true},
                "Multiplies every stiffness")};
};

// Water; each mass is dragged on its own (paper, II.E).
struct OceanSimple {
  static constexpr std::string_view name = "ocean-simple", help = "drag on each mass";
  float point_drag = 1;       // [N s/m]
  Vec3 flow;                  // [m/s]
  Vec3 gravity;               // [m/s2]
  float stiffness_scale = 1;  // [1]
  friend bool operator==(const OceanSimple&, const OceanSimple&) = default;

  static constexpr std::tuple parameters{
      Parameter("point_drag", &OceanSimple::point_drag, "N s/m", Accepts::at_least_zero, {0, 10},
                "Drag of a mass, force over speed through the water"),
      Parameter("flow", &OceanSimple::flow, "m/s", Accepts::any, {-2, 2}, "Velocity of the water"),
      Parameter("gravity", &OceanSimple::gravity, "m/s2", Accepts::any, {-20, 20}, "Gravity").or_downward_magnitude(),
      Parameter("stiffness_scale", &OceanSimple::stiffness_scale, "", Accepts::at_least_zero, {0.01f, 1000, true},
                "Multiplies every stiffness")};
};

// Solid ground at z = 0. Masses of one robot that no spring joins repel each other.
struct Land {
  static constexpr std::string_view name = "land", help = "floor, friction, gravity";
  Vec3 gravity{0, 0, -9.81f};  // [m/s2]
  float friction = 0.8f;       // Coulomb coefficient [1]
  bool self_collision = true;
  float contact_stiffness = 100;  // k_c [N/m], times the stiffness scale
  float stiffness_scale = 200;    // [1]
  friend bool operator==(const Land&, const Land&) = default;

  static constexpr std::tuple parameters{
      Parameter("friction", &Land::friction, "", Accepts::at_least_zero, {0, 2}, "Coulomb friction of the floor, mu"),
      Parameter("self_collision", &Land::self_collision, "Repulsion between masses of one robot that no spring joins"),
      Parameter("contact_stiffness", &Land::contact_stiffness, "N/m", Accepts::at_least_zero, {0, 1000},
                "Stiffness of that repulsion, k_c, times the stiffness scale")
          .only_if(&Land::self_collision),
      Parameter("gravity", &Land::gravity, "m/s2", Accepts::any, {-20, 20}, "Gravity").or_downward_magnitude(),
      Parameter("stiffness_scale", &Land::stiffness_scale, "", Accepts::at_least_zero, {0.01f, 1000, true},
                "Multiplies every stiffness")};
};

// The list of environments. Names, options, panels and the kernels of both backends follow from it.
using Environment = std::variant<Ocean, OceanSimple, Land>;

// Calls visit(Kind{}) with each environment in its default state.
template <class Visit>
constexpr void for_each_environment(Visit&& visit) {
  [&]<std::size_t... i>(std::index_sequence<i...>) { (visit(std::variant_alternative_t<i, Environment>{}), ...); }
  (std::make_index_sequence<std::variant_size_v<Environment>>{});
}

// for_each_parameter (parameters.h) of the environment that is chosen.
template <class Visit>
constexpr void for_each_parameter(Environment& environment, Visit&& visit) {
  std::visit([&](auto& kind) { for_each_parameter(kind, visit); }, environment);
}
template <class Visit>
constexpr void for_each_parameter(const Environment& environment, Visit&& visit) {
  std::visit([&](const auto& kind) { for_each_parameter(kind, visit); }, environment);
}

enum class DeviceKind { automatic, cpu, cuda };

struct Device {
  static constexpr int all_devices = -1;    // a batch is divided among all CUDA devices
  DeviceKind kind = DeviceKind::automatic;  // automatic: CUDA if there is a device, else the CPU
  int index = 0;                            // which CUDA device, or all_devices
  int threads = 0;                          // CPU threads; 0 = all cores
  friend bool operator==(const Device&, const Device&) = default;

  static constexpr std::tuple parameters{
      Parameter("threads", &Device::threads, "", Accepts::at_least_zero, {0, 256}, "CPU threads; 0 = all cores")};
};

struct Configuration {
  double dt = 1e-3;      // time step [s]
  double damping = 0.1;  // velocities shrink by exp(-damping dt) per step [1/s]
  Solver solver = Solver::force;
  Environment environment = Ocean{};
  Device device;
  friend bool operator==(const Configuration&, const Configuration&) = default;

  // The rest has tables of its own (environment, device) or names (solver).
  static constexpr std::tuple parameters{
      Parameter("dt", &Configuration::dt, "s", Accepts::above_zero, {1e-5f, 0.02f, true}, "Time step"),
      Parameter("damping", &Configuration::damping, "1/s", Accepts::at_least_zero, {0, 5},
                "Damping; velocities shrink by exp(-damping dt) per step")};
};

// "force", "xpbd"; "ocean", "ocean-simple", "land"; "auto", "cpu", "cuda", "cuda:1", "cuda:all".
std::string_view name_of(Solver solver);
std::vector<std::string_view> environment_names();
std::string_view name_of(const Environment& environment);
std::string name_of(const Device& device);
// The reverse, with the environment's defaults. Throw ParameterError that lists what is accepted.
Solver solver_named(std::string_view name);
Environment environment_named(std::string_view name);
Device device_named(std::string_view name);

Vec3 gravity_of(const Environment& environment);
float stiffness_scale_of(const Environment& environment);

// Throws ParameterError ("density: -1 is not accepted; give a finite number >= 0 kg/m3") unless every parameter has a
// value that its table accepts.
void validate(const Configuration& configuration);

}  // namespace mercury
