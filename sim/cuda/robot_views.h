// SPDX-License-Identifier: Apache-2.0
// The states of all robots of a batch, in its order, whatever their size classes and places are. One launch visits all:
// it costs the host a few microseconds, and a batch may have a dozen classes.
//
//   block i of a launch  ->  view of robot i  ->  its chunks of the state and of the numbers of its masses
#pragma once

#include <cuda_runtime_api.h>

#include <cstdint>

#include "mercury/backend.h"
#include "sim/cuda/layout.h"

namespace mercury::cuda {

// A robot in device memory. Valid until robots come or go.
struct RobotView {
  float* state;                // [tile][state_fields][32]
  const std::uint16_t* order;  // [slot], the mass that stands there, by its number
  const float* point_masses;   // [slot] [kg]; null = 1 kg
  DeviceStatus* status;
  std::uint64_t first_mass;  // among the masses of the batch
  std::uint32_t masses;
  double mass;  // [kg]
};

// These are asynchronous.

// Writes the states of `count` robots into those arrays that are not null. The order of each sum depends only on the
// robot, so centers are reproducible.
void publish_states(const RobotView* robots, std::size_t count, const PublishedArrays& arrays, cudaStream_t stream);

// Puts those robots whose element of `mask` is not 0 back to the start; they have not exploded. `start` = positions and
// velocities of all masses of the batch, [mass][6].
void put_masked_at_rest(const RobotView* robots, std::size_t count, const float* start, const std::uint8_t* mask,
                        cudaStream_t stream);

}  // namespace mercury::cuda
