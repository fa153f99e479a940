// SPDX-License-Identifier: Apache-2.0
// Telemetry as the device reports it.
#pragma once

#include <cstdint>

#include "mercury/vec3.h"

namespace mercury::cuda {

// One line of the host's memory, written at once.
struct alignas(64) DeviceTelemetry {
  Vec3 center_of_mass, velocity;
  float largest_strain;
  std::uint32_t bad_mass;
  double kinetic_energy, elastic_energy;
  long long exploded_step;
};

}  // namespace mercury::cuda
