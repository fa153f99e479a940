// SPDX-License-Identifier: Apache-2.0
// The network that a robot is grown from (paper, III.B): a multilayer perceptron from a random point to a place in
// space and a score for each base material.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace mercury {

inline constexpr int network_outputs = 3 + 22;  // a place, and a score for each base material
inline constexpr int max_network_width = 4096;
inline constexpr int max_network_layers = 16;

// y = weights x + biases.
struct Layer {
  int inputs = 0, outputs = 0;
  std::vector<float> weights;  // [outputs][inputs], row after row
  std::vector<float> biases;   // [outputs]
  friend bool operator==(const Layer&, const Layer&) = default;
};

// Layers one after the other with max(0, .) between them; the last one gives 3 + 22 numbers.
struct Network {
  std::vector<Layer> layers;
  friend bool operator==(const Network&, const Network&) = default;
};

// Sizes from the input to the output: {3, 64, 64, 25}.
std::vector<int> sizes_of(const Network& network);

// Throws InputError("<where>...") unless there are 1 to 16 layers of 1 to 4,096 inputs, each fitting the next, the
// last with 25 outputs, with as many weights and biases as that needs. The values may be anything.
void validate(const Network& network, const std::string& where = "network");

// The network's outputs for `count` points; `points` holds count x inputs floats, point after point, the result
// count x 25. Every output is a sum in the order bias, input 0, input 1, ..., rounded after each step: the same bits on
// every machine.
std::vector<float> evaluate(const Network& network, std::span<const float> points);

// The same for layers alone, whatever the last one gives; count x its outputs.
std::vector<float> evaluate(std::span<const Layer> layers, std::span<const float> points);

// exp(score) / sum of exp(scores), computed without overflow.
std::vector<double> softmax(std::span<const float> scores);

// Index of the most probable one, ties to the lower index. Softmax keeps the order, so that the scores themselves are
// compared and no rounding of exp can change a robot.
std::size_t most_probable(std::span<const float> scores);

// A network whose weights and biases change: each with probability `rate` by a normal number times `size`. The same
// seed gives the same change. Throws InputError unless 0 <= rate <= 1 and size >= 0 is finite.
Network mutate(const Network& network, double rate, double size, std::uint64_t seed);

// A child of two networks of equal sizes. Neurons are inherited whole (all weights into it and its bias) from either
// parent, each with probability 1/2: a neuron's weights mean something together, single weights do not. Throws
// InputError if the sizes differ.
Network crossover(const Network& a, const Network& b, std::uint64_t seed);

}  // namespace mercury
