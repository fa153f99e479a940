// SPDX-License-Identifier: Apache-2.0
// Telemetry as the device reports it.
#pragma once

#include <cstdint>

#include "mercury/vec3.h"

namespace mercury::cuda {

// A warp writes it to host memory in one transaction; kernels.h adds `inverted`.
struct alignas(128) DeviceTelemetry {
  Vec3 center_of_mass, velocity;  // [m], [m/s]
  float largest_strain;
  std::uint32_t bad_mass;
  double kinetic_energy, elastic_energy;  // [J]
  long long exploded_step;
  float muscle_power;  // [W]
  float strained_share;
  float inverted;  // NaN = not measured
};
static_assert(sizeof(DeviceTelemetry) == 128);

}  // namespace mercury::cuda
