// SPDX-License-Identifier: Apache-2.0
// The network that grows a robot (paper, III.B): a multilayer perceptron that takes a random point to a place in space
// and a score for each base material; on request also to how its muscle moves and how stiff it is.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace mercury {

inline constexpr int network_outputs = 3 + 22;  // a place, and a score for each base material
// And fields: phase, frequency, amplitude, stiffness (nn_robot.h).
inline constexpr int network_field_outputs = network_outputs + 4;
inline constexpr int max_network_width = 4096;
inline constexpr int max_network_layers = 16;

// y = weights x + biases.
struct Layer {
  int inputs = 0, outputs = 0;
  std::vector<float> weights;  // [outputs][inputs], row after row
  std::vector<float> biases;   // [outputs]
  friend bool operator==(const Layer&, const Layer&) = default;
};

// Layers with max(0, .) between them. The last one has 3 + 22 outputs, or 3 + 22 + 4 with fields.
struct Network {
  std::vector<Layer> layers;
  bool has_fields() const { return !layers.empty() && layers.back().outputs == network_field_outputs; }
  friend bool operator==(const Network&, const Network&) = default;
};

// Numbers of neurons from the input to the output, as in {3, 64, 64, 25}.
std::vector<int> sizes_of(const Network& network);

// Throws InputError("<where>...") unless there are 1 to 16 layers of 1 to 4,096 inputs and outputs, each layer takes
// the outputs of the one before, the last one has 25 or 29 outputs, and the weights and biases match these sizes. Does
// not check their values.
void validate(const Network& network, const std::string& where = "network");

// The network's outputs for some points: `points` holds points x inputs floats, point after point, the result
// points x 25 (or 29). Each output is summed in the order bias, input 0, input 1, ... and rounded after each step, so
// it has the same bits on every machine. Throws InputError if the number of floats is not a multiple of the inputs.
std::vector<float> evaluate(const Network& network, std::span<const float> points);

// The same for layers that need not form a whole network. Returns points x outputs of the last layer.
std::vector<float> evaluate(std::span<const Layer> layers, std::span<const float> points);

// exp(score) / sum of exp(scores), computed without overflow.
std::vector<double> softmax(std::span<const float> scores);

// Index of the most probable material; ties go to the lower index. Softmax keeps the order, so this compares the scores
// themselves, and the rounding of exp cannot change a robot.
std::size_t most_probable(std::span<const float> scores);

// A changed network: each weight and bias changes with probability `rate`, by a normal number times `size`. The same
// seed gives the same change. Unless rate or size is 0, at least one weight changes: a draw without a change is
// repeated up to 30 times, then one weight moves by one unit in its last place. Throws InputError unless 0 <= rate <= 1
// and size is finite and at least 0.
Network mutate(const Network& network, double rate, double size, std::uint64_t seed);

// A child of two networks of equal sizes. It inherits each neuron whole, its bias and all weights into it, from either
// parent with probability 1/2: the weights of a neuron have a meaning together, single weights do not. Throws
// InputError if the sizes differ.
Network crossover(const Network& a, const Network& b, std::uint64_t seed);

}  // namespace mercury
