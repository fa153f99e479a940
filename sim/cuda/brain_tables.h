// SPDX-License-Identifier: Apache-2.0
// Brains in device memory, and what the step kernel keeps of each robot's brain through a launch:
//
//   +---------------+----------+------+-----------------------+---------+--------+----------------+---------+
//   | ThinkingRobot | measures | sums | senses, neurons, sums | muscles | clamps | plan and body  | weights |
//   +---------------+----------+------+-----------------------+---------+--------+----------------+---------+
//                                                                                  if they fit on the chip
//
// A thought is a chain of short sums that wait for one another. So that they need not wait for device memory too, all
// of this lies in shared memory if there is room (BrainBytes), and results are stored to device memory besides. Plans
// that several robots have are in device memory once; states stand in the order of the batch.
#pragma once

#include <cstdint>

#include "sim/cuda/kernels.h"
#include "sim/physics/brain_plan.h"
#include "sim/physics/senses.h"

namespace mercury::cuda {

// A mass at rest, as the frame of the body is found by it. One access reads it.
struct alignas(16) RestingMass {
  Vec3 moment;  // its mass times its position from the center of the body [kg m]
  float mass;   // [kg]
};
struct SensedSpring {
  std::uint16_t a, b;  // slots
  float inverse_rest_length;
};

// BrainPlan::Place with slots.
struct SensedPlace {
  std::uint32_t first_row;                   // of its sums
  std::uint32_t mass_shares, spring_shares;  // first come the rows of masses, then those of springs
  std::uint32_t masses, springs;
  double mass;  // of its masses together [kg]
};

// What a warp adds up for a place at once, in floats, into a row of sums: every `tiles_per_share` tiles of the whole
// body, into two rows if it senses how it turns, and entries of lists. The rows are then added up in double precision.
// The cut depends on the robot and not on the number of warps, nor do the sums.
struct SensingShare {
  bool of_springs;  // else of masses
  std::uint32_t row, count;
  std::uint64_t first;  // in the lists
};
inline constexpr std::uint32_t tiles_per_share = 3, entries_per_share = 256, sums_per_row = 16;

// How a brain drives a material of its robot.
struct BrainMuscle {
  float amplitude;
  std::uint32_t neuron;  // or none
};
struct BrainMaterial {
  const Material* own;
  std::uint32_t setting;  // index in the shared arrays
  std::uint32_t neuron;   // or BrainPlan::none
};

// The parts of a brain's memory begin here [bytes], from its own beginning, or from that of the plan or the body.
struct BrainOffsets {
  std::uint32_t measures, sums, values, muscles, clamps;
  std::uint32_t neurons, runs, gates, learnings, layers, outputs;  // of the plan, after the senses
  std::uint32_t shares;                                            // of the body, after the places
};

// The head of a brain's memory. Device memory has it as set by the host; a launch copies it and completes it.
struct ThinkingRobot {
  BrainOffsets at;
  std::uint32_t robot;  // in the batch
  float period;
  std::uint32_t senses, neurons, layers, outputs, samples, weight_count;
  std::uint32_t places, tile_shares, listed_shares, materials;
  std::uint32_t plan_bytes, body_bytes;
  bool uses_frame, uses_turn_rate;
  // In device memory, plan, body and weights in the brain's memory if they fit.
  const char *plan, *body;
  float* weights;
  float *stored_weights, *activations, *samples_of_senses;
  const float* clamps;
  const RestingMass* rest;  // [slot], if sums over the whole body are measured
  const Vec3* target;       // [m]
  const std::uint16_t* slots;
  const SensedSpring* springs;
  const std::uint64_t* noise_seed;
  std::uint64_t* thoughts;
  const BrainMaterial* material_sources;  // [materials]
  Material* materials_now;                // [materials], as the two that follow
  MusclePhase* phases;
  MuscleSwing* swings;
  std::uint64_t seed;
  // Completed by a launch.
  SensedWorld world;
  std::uint64_t thought;
  std::int64_t steps_per_thought;
  const float* point_masses;  // [slot] [kg]; null = 1 kg
  double mass;                // of all together [kg]
  std::uint32_t masses;
};

// What a launch of steps needs of brains.
struct Thoughts {
  static constexpr std::uint32_t none = 0xffffffffu;
  const std::uint32_t* thinkers = nullptr;  // by place: which of `robots` it is, or none; null = no robot thinks
  const ThinkingRobot* robots = nullptr;
  char* workspace = nullptr;  // [robots], of brains whose memory is not on the chip
  std::uint32_t workspace_stride = 0;
  SensedWorld world{};
  ActuationSources sources{};
};

}  // namespace mercury::cuda
