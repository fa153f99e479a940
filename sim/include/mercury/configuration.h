// SPDX-License-Identifier: Apache-2.0
// Configuration of a simulation: time step, solver, environment, device.
#pragma once

#include <string>
#include <string_view>
#include <tuple>

#include "mercury/environment.h"
#include "mercury/parameters.h"
#include "mercury/physics.h"

namespace mercury {

enum class Solver { force, xpbd };  // paper, Algorithm 1 and Algorithm 2

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

// The configuration that such bodies begin with in the environment of this name, or in their own if it is empty: the
// ocean, or water. Real bodies have damping inside, so none outside; no factor for their stiffness; and contacts that
// follow it. Throws as environment_named().
Configuration default_configuration(Physics physics, std::string_view environment = "");

// "force", "xpbd"; "auto", "cpu", "cuda", "cuda:1", "cuda:all".
std::string_view name_of(Solver solver);
std::string name_of(const Device& device);
// The reverse. Throw ParameterError that lists what is accepted.
Solver solver_named(std::string_view name);
Device device_named(std::string_view name);

// Throws ParameterError ("density: -1 is not accepted; give a finite number >= 0 kg/m3") unless every parameter has a
// value that its table accepts.
void validate(const Configuration& configuration);

}  // namespace mercury
