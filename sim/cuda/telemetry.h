// SPDX-License-Identifier: Apache-2.0
// Telemetry as the device reports it.
#pragma once

#include <cstddef>
#include <cstdint>

#include "mercury/host_device.h"
#include "mercury/vec3.h"

namespace mercury::cuda {

// A warp writes it to host memory in one transaction.
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

// A cell of a body (mercury/folding.h).
struct DeviceCell {
  static constexpr std::uint16_t no_corner = 0xffff;
  std::uint16_t corners[8];  // slots; a tetrahedron has four, and then no_corner
  float volume;              // at rest [m3]
};
// The cells of a robot, which are most_cells_per_slot times its slots at most.
struct RobotCells {
  std::uint32_t first, count;
  double volume;  // of all of them [m3]; NaN = not measured
};
constexpr std::size_t most_cells_per_slot = 32;

// What a launch reports.
struct Reports {
  DeviceTelemetry* first = nullptr;    // [report][stride], of which the launch fills one per robot; null = no reports
  std::uint32_t every = 0;             // steps of the launch; 0 = once, without a step
  std::uint32_t stride = 0;            // robots of the batch
  const RobotCells* robots = nullptr;  // [robot], or null if `inverted` is not measured
  const DeviceCell* cells = nullptr;

  // Whether a report follows this number of steps, and which.
  MERCURY_HOST_DEVICE bool follow(std::uint32_t steps) const {
    return first && (every == 0 || (steps > 0 && steps % every == 0));
  }
  MERCURY_HOST_DEVICE DeviceTelemetry* after(std::uint32_t steps) const {
    return every == 0 ? first : first + std::size_t{stride} * (steps / every - 1);
  }
  // The step after which the next one is due, of a launch of that many.
  MERCURY_HOST_DEVICE std::uint32_t next(std::uint32_t step, std::uint32_t launch_steps) const {
    return first && every > 0 ? step - step % every + every : launch_steps;
  }
};

}  // namespace mercury::cuda
