// SPDX-License-Identifier: Apache-2.0
// Brains in device memory. Plans that several robots share are there once; states stand in the order of the batch.
#pragma once

#include <cstdint>

#include "sim/cuda/kernels.h"
#include "sim/physics/brain_plan.h"
#include "sim/physics/senses.h"

namespace mercury::cuda {

struct SensedSpring {
  std::uint16_t a, b;  // slots
  float inverse_rest_length;
};

// BrainPlan::Place with slots.
struct SensedPlace {
  std::uint32_t first_row;                   // of its sums among those of the robot
  std::uint32_t mass_shares, spring_shares;  // first come the rows of masses, then those of springs
  std::uint32_t masses, springs;
  double mass;  // of its masses together [kg]
};

// What a warp adds up for a place at once, in floats, into a row of sums; of tiles of a body that senses how it turns,
// into two. The rows are then added up in double precision. The cut depends on the robot and not on the number of
// warps, nor do the sums.
struct SensingShare {
  enum Kind : std::uint32_t { tiles, masses, springs };
  Kind kind;
  std::uint32_t row, count;
  std::uint64_t first;  // tile of the robot, or entry of the lists
};
inline constexpr std::uint32_t tiles_per_share = 3, entries_per_share = 256, sums_per_row = 16;

struct BrainLayer : BrainPlan::Layer {
  bool reads_itself;  // a neuron has inputs from neurons of its layer
};

// Where the parts of a brain begin in the tables.
struct ThinkingRobot {
  std::uint32_t robot;  // in the batch
  std::uint32_t brain;  // among the brains
  float period;
  std::uint64_t seed;
  std::uint64_t first_sense, first_neuron, first_run, first_gate, first_learning, first_layer,
      first_output;  // of the plan
  std::uint32_t senses, neurons, layers, outputs, samples, weights;
  std::uint64_t first_place, first_share, first_row, first_rest, first_activation, first_sample, first_weight,
      first_driven, first_scratch;
  std::uint32_t places, shares, driven;
  bool uses_frame, uses_turn_rate;
};

// Pointers to all of them.
struct BrainTables {
  const ThinkingRobot* robots;
  const BrainPlan::Sense* senses;
  const BrainPlan::Neuron* neurons;
  const BrainPlan::Run* runs;
  const BrainPlan::Gate* gates;
  const BrainPlan::Learning* learnings;
  const BrainLayer* layers;
  const BrainPlan::Output* outputs;
  const SensedPlace* places;
  const SensingShare* shares;
  const std::uint16_t* slots;
  const SensedSpring* springs;
  const Vec3* rest;  // [slot], from the center [m]
  float *activations, *samples, *weights;
  const float* clamps;
  const Vec3* targets;
  std::uint64_t* thoughts;
  const std::uint64_t* noise_seeds;
  // For the time of a thought.
  float (*sums)[sums_per_row];
  PlaceMeasures* measures;  // one per place
  BodyMeasures* bodies;     // one per brain
  float* scratch;           // senses, neurons, sums of neurons, of each brain
};

// What a launch of steps needs of brains.
struct Thoughts {
  static constexpr std::uint32_t none = 0xffffffffu;
  const std::uint32_t* thinkers = nullptr;  // by place: which of tables.robots it is, or none; null = no robot thinks
  BrainTables tables{};
  SensedWorld world{};
  ActuationSources sources{};
  const DrivenMaterial* driven = nullptr;
};

}  // namespace mercury::cuda
