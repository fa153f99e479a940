// SPDX-License-Identifier: Apache-2.0
// What evolution changes in a brain: its weights. Sensors, layers and what is joined to what stay.
//
// All weights move at once, by a step that adapts itself (mutation_step.h), n = number of weights:
//
//   w_i   <-  w_i + strength step N_i(0, 1)
#pragma once

#include <cstdint>
#include <vector>

#include "mercury/brain.h"
#include "mercury/robot.h"
#include "robots/bytes.h"

namespace mercury {

struct BrainGenes {
  static constexpr double first_step = 0.1, smallest_step = 1e-4, largest_step = 10;

  std::vector<float> weights;  // in the order of weights_of()
  double step = first_step;    // [of a weight]

  BrainGenes mutated(double strength, std::uint64_t seed) const;
  // Of two brains whose structure is that of `brain`: each neuron, with its bias and the weights of its inputs, comes
  // from one of them, as networks cross. The step is the geometric mean of theirs.
  BrainGenes crossed(const BrainGenes& other, const Brain& brain, std::uint64_t seed) const;

  // As a weight, which is finite.
  static float limited_weight(double weight);

  void write(ByteWriter& writer) const;
  // Throws InputError for numbers that mutated() cannot give, or for another number of weights than `count`.
  static BrainGenes read(ByteReader& reader, std::size_t count);
};

// Whether two robots have brains and sensors that differ in weights alone.
bool same_brain_structure(const Robot& a, const Robot& b);

// The brain of robots that have none: one per actuator (Brain::per_actuator), so that it fits any body with a muscle.
// Each copy senses the strain of its muscle, the outputs of its neighbors, a clock and the direction of the target. All
// weights are 0.
void give_brain_per_actuator(Robot& robot, float clock_frequency);
// The brain of a robot that has sensors and no brain: a neuron per actuator, which reads nothing yet.
void give_layer_of_outputs(Robot& robot);
// Normal random numbers in place of the weights, with the standard deviation 1.
BrainGenes random_brain_genes(const Brain& brain, std::uint64_t seed);

// The mean frequency of what moves a robot [rad/s]; that of the default muscles if nothing does.
float mean_muscle_frequency(const Robot& robot);

}  // namespace mercury
