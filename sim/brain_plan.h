// SPDX-License-Identifier: Apache-2.0
// A brain as flat lists of numbers: what a thought reads and computes, in its order.
//
//   z = [ senses | neurons ]          a neuron adds up runs: consecutive elements of z times consecutive weights
//
//   neuron 5:  bias | run: z[0..11] w[40..51] | run: z[14..17] w[52..55] | ...
//
// A row of a matrix is one run, an edge a run of length one. In a brain per actuator, the senses and neurons of all
// copies stand there, actuator after actuator within a layer, and their runs read the same weights.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "mercury/brain.h"
#include "mercury/robot.h"

namespace mercury {

struct BrainPlan {
  static constexpr std::uint32_t none = 0xffffffffu;

  // Where sensors are. Without an entry, they are everywhere.
  struct Place {
    std::vector<std::uint32_t> springs;
    std::vector<std::uint16_t> masses;
  };
  struct Sense {
    SensorKind kind;
    std::uint32_t component;      // of what the sensor gives
    std::uint32_t place = none;   // in `places`
    std::uint32_t neuron = none;  // whose value it is; `none` = 0
    float gain, noise, frequency, phase;
    std::uint32_t delay;  // in thoughts
  };
  struct Run {
    std::uint32_t source, count, weight;
  };
  struct Neuron {
    std::uint32_t first_run, runs;
    std::uint32_t bias;  // its weight; `none` = 0
    float alpha;
    Activation activation;
  };
  struct Learning {
    std::uint32_t neuron, source, weight;
    float rate;
  };
  struct Layer {
    std::uint32_t first, count;  // neurons
    std::uint32_t first_learning, learnings;
  };
  struct Output {
    std::uint32_t actuator, neuron;
  };

  float period = 0;
  std::uint64_t seed = 0;
  std::vector<Place> places;
  std::vector<Sense> senses;
  std::vector<Neuron> neurons;
  std::vector<Run> runs;
  std::vector<Learning> learnings;
  std::vector<Layer> layers;
  std::vector<Output> outputs;
  std::vector<float> weights;
  std::size_t samples = 1;  // of the senses that delays need

  bool uses_state = false;  // a sense depends on positions or velocities
};

// Of a robot with a brain that validate() accepts.
BrainPlan make_brain_plan(const Robot& robot);

BrainState state_at_start(const BrainPlan& plan);

}  // namespace mercury
