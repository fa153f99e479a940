// SPDX-License-Identifier: Apache-2.0
// What a simulation is told: time step, solver, environment, device.
#pragma once

#include <string>
#include <string_view>
#include <variant>

#include "mercury/vec3.h"

namespace mercury {

enum class Solver { force, xpbd };  // paper, Algorithm 1 and Algorithm 2

// Water; drag and lift act on the faces (paper, equation 1).
struct Ocean {
  static constexpr std::string_view name = "ocean";
  float density = 1000;           // rho [kg/m3]
  float drag_coefficient = 1;     // C_D [1]
  float lift_coefficient = 0.2f;  // C_L [1]
  Vec3 flow;                      // velocity of the water [m/s]
  Vec3 gravity;                   // [m/s2]
  float stiffness_scale = 1;      // multiplies every stiffness [1]
  friend bool operator==(const Ocean&, const Ocean&) = default;
};

// Water; each mass is dragged on its own (paper, II.E).
struct OceanSimple {
  static constexpr std::string_view name = "ocean-simple";
  float point_drag = 1;       // [N s/m]
  Vec3 flow;                  // [m/s]
  Vec3 gravity;               // [m/s2]
  float stiffness_scale = 1;  // [1]
  friend bool operator==(const OceanSimple&, const OceanSimple&) = default;
};

// Solid ground at z = 0, and masses of one robot that no spring joins repel each other.
struct Land {
  static constexpr std::string_view name = "land";
  Vec3 gravity{0, 0, -9.81f};  // [m/s2]
  float friction = 0.8f;       // Coulomb coefficient [1]
  bool self_collision = true;
  float contact_stiffness = 100;  // k_c [N/m], times the stiffness scale
  float stiffness_scale = 200;    // [1]
  friend bool operator==(const Land&, const Land&) = default;
};

using Environment = std::variant<Ocean, OceanSimple, Land>;

enum class DeviceKind { automatic, cpu, cuda };

struct Device {
  static constexpr int all_devices = -1;    // a batch is shared out over every CUDA device
  DeviceKind kind = DeviceKind::automatic;  // automatic: CUDA if a device is there, else the CPU
  int index = 0;                            // which CUDA device, or all_devices
  int threads = 0;                          // CPU threads; 0 = all cores
  friend bool operator==(const Device&, const Device&) = default;
};

struct Configuration {
  double dt = 1e-3;      // time step [s]
  double damping = 0.1;  // velocities shrink by exp(-damping dt) a step [1/s]
  Solver solver = Solver::force;
  Environment environment = Ocean{};
  Device device;
  friend bool operator==(const Configuration&, const Configuration&) = default;
};

// "force", "xpbd"; "ocean", "ocean-simple", "land"; "auto", "cpu", "cuda", "cuda:1", "cuda:all".
std::string_view name_of(Solver solver);
std::string_view name_of(const Environment& environment);
std::string name_of(const Device& device);
// The reverse, with the environment's defaults. Throw ParameterError that lists what is accepted.
Solver solver_named(std::string_view name);
Environment environment_named(std::string_view name);
Device device_named(std::string_view name);

Vec3 gravity_of(const Environment& environment);
float stiffness_scale_of(const Environment& environment);

// Throws ParameterError ("density: -1 is not accepted; give a finite number >= 0 kg/m3")
// unless dt > 0, damping >= 0, densities, coefficients, friction, drag and stiffness scales >= 0, and everything is
// finite.
void validate(const Configuration& configuration);

}  // namespace mercury
