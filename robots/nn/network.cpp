// SPDX-License-Identifier: Apache-2.0
#include "mercury/network.h"

#include <algorithm>
#include <cmath>

#include "mercury/error.h"
#include "mercury/random.h"
#include "robots/nn/perceptron.h"

namespace mercury {
namespace {

Network disturbed(const Network& network, double rate, double size, std::uint64_t seed) {
  Random random(seed);
  Network mutant = network;
  const auto disturb = [&](std::vector<float>& values) {
    for (float& value : values)
      if (random.chance(rate)) value = static_cast<float>(value + size * random.normal());
  };
  for (Layer& layer : mutant.layers) {
    disturb(layer.weights);
    disturb(layer.biases);
  }
  return mutant;
}

}  // namespace

std::vector<int> sizes_of(const Network& network) {
  std::vector<int> sizes;
  if (network.layers.empty()) return sizes;
  sizes.push_back(network.layers.front().inputs);
  for (const Layer& layer : network.layers) sizes.push_back(layer.outputs);
  return sizes;
}

void validate(const Network& network, const std::string& where) {
  const auto require = [&](bool holds, const std::string& what) {
    if (!holds) throw InputError(where, what);
  };
  require(!network.layers.empty() && network.layers.size() <= max_network_layers, "1 to 16 layers are accepted");
  int inputs = network.layers.front().inputs;
  for (const Layer& layer : network.layers) {
    require(layer.inputs >= 1 && layer.inputs <= max_network_width && layer.outputs >= 1 &&
                layer.outputs <= max_network_width,
            "a layer has 1 to 4096 inputs and outputs");
    require(layer.inputs == inputs, "a layer of " + std::to_string(layer.inputs) + " inputs follows one of " +
                                        std::to_string(inputs) + " outputs");
    const auto rows = static_cast<std::size_t>(layer.outputs), columns = static_cast<std::size_t>(layer.inputs);
    require(layer.weights.size() == rows * columns && layer.biases.size() == rows,
            "a layer of " + std::to_string(layer.inputs) + " inputs and " + std::to_string(layer.outputs) +
                " outputs has " + std::to_string(layer.weights.size()) + " weights and " +
                std::to_string(layer.biases.size()) + " biases");
    inputs = layer.outputs;
  }
  require(inputs == network_outputs || inputs == network_field_outputs,
          "the last layer gives 25 numbers (a place and 22 scores) or 29 (four fields as well), not " +
              std::to_string(inputs));
}

std::vector<float> evaluate(const Network& network, std::span<const float> points) {
  validate(network);
  if (points.size() % static_cast<std::size_t>(network.layers.front().inputs) != 0)
    throw InputError("network", "points of " + std::to_string(network.layers.front().inputs) + " numbers are expected");
  return evaluate(std::span(network.layers), points);
}

std::vector<float> evaluate(std::span<const Layer> layers, std::span<const float> points) {
  return evaluate_layers(layers, points);
}

std::vector<double> softmax(std::span<const float> scores) {
  std::vector<double> probabilities(scores.begin(), scores.end());
  if (scores.empty()) return probabilities;
  const double largest = *std::max_element(scores.begin(), scores.end());
  double sum = 0;
  for (double& p : probabilities) sum += p = std::exp(p - largest);
  for (double& p : probabilities) p /= sum;
  return probabilities;
}

std::size_t most_probable(std::span<const float> scores) {
  return static_cast<std::size_t>(std::max_element(scores.begin(), scores.end()) - scores.begin());
}

Network mutate(const Network& network, double rate, double size, std::uint64_t seed) {
  if (!(rate >= 0 && rate <= 1)) throw InputError("mutation rate", "a number from 0 to 1 is accepted");
  if (!(size >= 0 && std::isfinite(size))) throw InputError("mutation size", "a finite number >= 0 is accepted");
  if (rate == 0 || size == 0) return network;
  constexpr std::uint64_t attempts = 30;
  for (std::uint64_t attempt = 0; attempt < attempts; ++attempt) {
    Network mutant = disturbed(network, rate, size, attempt == 0 ? seed : seed_of(seed, attempt));
    if (mutant != network) return mutant;
  }
  Network mutant = network;
  if (mutant.layers.empty() || mutant.layers.front().weights.empty()) return mutant;
  std::vector<float>& weights = mutant.layers.front().weights;
  float& weight = weights[Random(seed).below(weights.size())];
  weight = std::nextafter(weight, weight > 0 ? 0.f : 1.f);
  return mutant;
}

Network crossover(const Network& a, const Network& b, std::uint64_t seed) {
  validate(a);
  validate(b);
  if (sizes_of(a) != sizes_of(b)) throw InputError("crossover", "two networks of equal sizes are needed");
  Random random(seed);
  Network child = a;
  for (std::size_t l = 0; l < child.layers.size(); ++l) {
    Layer& layer = child.layers[l];
    const Layer& other = b.layers[l];
    const std::ptrdiff_t inputs = layer.inputs;
    for (std::ptrdiff_t neuron = 0; neuron < layer.outputs; ++neuron) {
      if (!random.chance(0.5)) continue;
      std::copy_n(other.weights.begin() + neuron * inputs, inputs, layer.weights.begin() + neuron * inputs);
      layer.biases[static_cast<std::size_t>(neuron)] = other.biases[static_cast<std::size_t>(neuron)];
    }
  }
  return child;
}

}  // namespace mercury
