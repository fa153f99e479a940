// Telemetry reduced on the device.
#pragma once

#include "sim/cuda/layout.h"

namespace mercury::cuda {

struct DeviceTelemetry {
  double sums[8];  // over the masses and springs: position, velocity, kinetic energy, elastic energy
  float largest_strain;
  std::uint32_t bad_mass;
  long long exploded_step;
};

// One block a robot; the order of every sum is fixed by the robot alone. `rows` = as the records are placed
// (Batch::place_records).
void launch_telemetry(const BatchView& batch, const Clock& clock, float stiffness_scale, std::uint32_t rows,
                      DeviceTelemetry* out);

}  // namespace mercury::cuda
