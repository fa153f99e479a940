// SPDX-License-Identifier: Apache-2.0
// A brain as flat lists of numbers: what a thought reads and computes, in its order.
//
//   z = [ senses | neurons ]          a neuron adds up runs: consecutive elements of z times consecutive weights
//
//   neuron 5:  bias | run: z[0..11] w[40..51] | run: z[14..17] w[52..55] | ...
//
// A row of a matrix is one run, an edge a run of length one. In a brain per actuator, the senses and neurons of all
// copies stand there, actuator after actuator within a layer, and their runs read the same weights.
//
// A gated layer has a Gate per neuron beside that. Other layers have none, so that they pay nothing for it.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mercury/brain.h"
#include "mercury/clock.h"
#include "mercury/host_device.h"
#include "mercury/robot.h"

namespace mercury {

// What has to be measured of a part of the body, as bits.
enum Measure : std::uint8_t {
  measure_center = 1,
  measure_velocity = 2,
  measure_strain = 4,
  measure_strain_rate = 8,
  measure_touch = 16
};

struct BrainPlan {
  static constexpr std::uint32_t none = 0xffffffffu;

  // Where sensors are. The first place is the whole body, without lists.
  struct Place {
    std::vector<std::uint32_t> springs;
    std::vector<std::uint16_t> masses;
    std::uint8_t measures = 0;
  };
  struct Sense {
    SensorKind kind;
    std::uint32_t component;      // of what the sensor gives
    std::uint32_t place = 0;      // in `places`
    std::uint32_t neuron = none;  // whose value it is; `none` = 0
    float gain, noise, frequency, phase;
    std::uint32_t delay;  // in thoughts
    friend bool operator==(const Sense&, const Sense&) = default;
  };
  struct Run {
    std::uint32_t source, count, weight;
    friend bool operator==(const Run&, const Run&) = default;
  };
  struct Neuron {
    std::uint32_t first_run, runs;
    std::uint32_t bias;  // its weight; `none` = 0
    float alpha;
    Activation activation;
    friend bool operator==(const Neuron&, const Neuron&) = default;
  };
  // How a neuron changes whose g or k is another neuron's activation, or whose k is a constant.
  struct Gate {
    static constexpr std::uint32_t rest = none - 1;
    std::uint32_t gate;  // the neuron that is g; `none` = alpha
    std::uint32_t keep;  // the neuron that is k; `none` = `constant`, `rest` = 1 - g
    float constant;
    friend bool operator==(const Gate&, const Gate&) = default;
  };
  struct Learning {
    std::uint32_t neuron, source, weight;
    float rate;
    friend bool operator==(const Learning&, const Learning&) = default;
  };
  struct Layer {
    std::uint32_t first, count;               // neurons
    std::uint32_t first_learning, learnings;  // of different weights
    std::uint32_t first_gate;                 // of as many gates as neurons; `none` = it has none
    friend bool operator==(const Layer&, const Layer&) = default;
  };
  struct Output {
    std::uint32_t actuator, neuron;
    friend bool operator==(const Output&, const Output&) = default;
  };

  float period = 0;
  std::uint64_t seed = 0;
  std::vector<Place> places;
  std::vector<Sense> senses;
  std::vector<Neuron> neurons;
  std::vector<Run> runs;
  std::vector<Gate> gates;
  std::vector<Learning> learnings;
  std::vector<Layer> layers;
  std::vector<Output> outputs;
  std::vector<float> weights;
  std::size_t samples = 1;  // of the senses that delays need

  bool uses_state = false;  // a sense depends on positions or velocities
  bool uses_frame = false, uses_turn_rate = false;

  // Whether all but places and weights is the same.
  bool has_tables_of(const BrainPlan& other) const {
    return period == other.period && seed == other.seed && samples == other.samples && senses == other.senses &&
           neurons == other.neurons && runs == other.runs && gates == other.gates && learnings == other.learnings &&
           layers == other.layers && outputs == other.outputs;
  }
};

// y <- y + alpha (act - y), of a neuron whose layer has no gates.
MERCURY_HOST_DEVICE float changed_activation(const BrainPlan::Neuron& neuron, float y, float act) {
  return neuron.alpha == 1 ? act : multiply_add(neuron.alpha, act - y, y);
}
// y <- k y + g act, with g and k among the activations of all neurons.
MERCURY_HOST_DEVICE float gated_activation(const BrainPlan::Gate& gate, float alpha, const float* neurons, float y,
                                           float act) {
  const float g = gate.gate == BrainPlan::none ? alpha : neurons[gate.gate];
  float k = gate.constant;
  if (gate.keep == BrainPlan::Gate::rest)
    k = 1 - g;
  else if (gate.keep != BrainPlan::none)
    k = neurons[gate.keep];
  return multiply_add(g, act, k * y);
}

// Steps between two thoughts.
MERCURY_HOST_DEVICE std::int64_t steps_per_thought(float period, double dt) {
  const double steps = std::floor(static_cast<double>(period) / dt + 0.5);
  return steps < 1 ? 1 : steps < 1e15 ? static_cast<std::int64_t>(steps) : std::int64_t{1} << 50;
}
MERCURY_HOST_DEVICE std::int64_t steps_since_thought(float period, const Clock& clock) {
  return (clock.step - clock.base_step) % steps_per_thought(period, clock.dt);
}
MERCURY_HOST_DEVICE std::int64_t steps_to_thought(float period, const Clock& clock) {
  const std::int64_t since = steps_since_thought(period, clock);
  return since == 0 ? 0 : steps_per_thought(period, clock.dt) - since;
}

// The brains of a batch as flat lists, one brain after the other.
struct PackedBrains {
  std::vector<float> neurons, senses, weights;  // as in BrainState
  std::vector<std::uint64_t> thoughts;          // per brain
  std::vector<float> clamps;                    // per neuron, NaN = it thinks
  std::vector<Vec3> targets;                    // per brain, NaN = that of the environment
  std::vector<std::uint64_t> noise_seeds;       // per brain
};

}  // namespace mercury
