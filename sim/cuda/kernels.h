// SPDX-License-Identifier: Apache-2.0
// All kernels but those of the step (step.h). They are in one source, since nvcc takes seconds to begin with each.
#pragma once

#include <cuda_runtime_api.h>

#include <cstddef>
#include <cstdint>

#include "mercury/backend.h"
#include "sim/cuda/layout.h"

namespace mercury::cuda {

// All functions below are asynchronous.

// A robot of a batch, whatever its size class and place are. Valid until robots come or go. One launch visits all
// robots of a batch: it costs the host a few microseconds, and a batch may have a dozen classes.
//
//   block i of a launch  ->  view of robot i  ->  its chunks of the state and of the numbers of its masses
struct RobotView {
  float* state;                // [tile][state_fields][32]
  const std::uint16_t* order;  // [slot], the mass that stands there, by its number
  const float* point_masses;   // [slot] [kg]; null = 1 kg
  DeviceStatus* status;
  std::uint64_t first_mass;  // among the masses of the batch
  std::uint32_t masses;
  double mass;  // [kg]
};

// Writes the states of `count` robots into those arrays that are not null. The order of each sum depends only on the
// robot, so centers are reproducible.
void publish_states(const RobotView* robots, std::size_t count, const PublishedArrays& arrays, cudaStream_t stream);

// Puts those robots whose element of `mask` is not 0 back to the start; they have not exploded. `start` = positions and
// velocities of all masses of the batch, [mass][6].
void put_masked_at_rest(const RobotView* robots, std::size_t count, const float* start, const std::uint8_t* mask,
                        cudaStream_t stream);

// Rewrites the partners of `count` records for tiles of another number of fields.
void readdress_partners(std::uint32_t* records, std::size_t count, std::uint32_t record_words, std::uint32_t old_fields,
                        std::uint32_t new_fields, cudaStream_t stream);
// The same for the corners of face pairs on the device.
void readdress_corners(std::span<FacePair> pairs, std::uint32_t old_fields, std::uint32_t new_fields,
                       cudaStream_t stream);

// Copies the properties of masses from whole robots to their parts. `parts` = DeviceParts::view().
void copy_points_to_parts(const BatchView& parts, const PointProperties* from, PointProperties* to,
                          cudaStream_t stream);

// Copies chunks of words. `moves` is on the device: (from, to), of which no chunk is in two.
void move_chunks(std::uint32_t* words, std::size_t words_per_chunk, const uint2* moves, std::size_t count,
                 cudaStream_t stream);

void compute_phases(const Material* materials, MusclePhase* phases, MuscleSwing* swings, std::size_t count,
                    const Clock& clock, cudaStream_t stream);

// Replaces the material that each spring record names; `ids` = [robot][max_materials], the new id by the old one.
void rename_materials(std::uint32_t* records, std::size_t robots, std::size_t records_per_robot,
                      std::uint32_t record_words, const MaterialId* ids, cudaStream_t stream);

// A material that an actuator drives (actuation.h).
struct DrivenMaterial {
  const Material* own;
  Material* now;
  MusclePhase* phase;
  MuscleSwing* swing;
  DeviceStatus* status;   // of the robot
  std::uint32_t setting;  // index in the shared arrays
};

// Computes all driven materials, and their phases for this clock. `before_step`: robots whose drives have failed
// explode.
void actuate(const DrivenMaterial* driven, std::size_t count, const ActuationSources& sources, const Clock& clock,
             bool before_step, cudaStream_t stream);

}  // namespace mercury::cuda
