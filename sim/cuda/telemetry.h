// SPDX-License-Identifier: Apache-2.0
// Telemetry as the device reports it.
#pragma once

#include <cstdint>

#include "mercury/vec3.h"

namespace mercury::cuda {

// Aligned so that the device writes it to host memory in one transaction.
struct alignas(64) DeviceTelemetry {
  Vec3 center_of_mass, velocity;  // [m], [m/s]
  float largest_strain;
  std::uint32_t bad_mass;
  double kinetic_energy, elastic_energy;  // [J]
  long long exploded_step;
  float muscle_power;  // [W]
  float strained_share;
};
static_assert(sizeof(DeviceTelemetry) == 64);

}  // namespace mercury::cuda
