// SPDX-License-Identifier: Apache-2.0
// What the neurons of a brain do, by docs/brains.md, in double precision: an independent calculation for tests.
#pragma once

#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "mercury/brain.h"

namespace mercury {

class Thought {
 public:
  explicit Thought(Brain brain) : brain_(std::move(brain)) {
    for (const NeuronLayer& layer : brain_.layers)
      index_[layer.name] = states_.size(), states_.emplace_back(layer.neurons);
  }

  // Begins with neurons that are 0.
  void forget() {
    for (std::vector<double>& state : states_) std::ranges::fill(state, 0);
  }
  // The last layer after one thought.
  const std::vector<double>& think(const std::vector<double>& senses) {
    for (std::size_t i = 0; i < states_.size(); ++i) {
      const NeuronLayer& layer = brain_.layers[i];
      std::vector<double> next(layer.neurons);
      for (std::size_t k = 0; k < layer.neurons; ++k) next[k] = layer.bias.empty() ? 0 : layer.bias[k];
      for (const NeuronInput& input : layer.inputs) {
        const std::vector<double>& from = input.from == "senses" ? senses : states_[index_.at(input.from)];
        for (std::size_t k = 0; k < input.weights.size(); ++k)
          next[k / from.size()] += input.weights[k] * from[k % from.size()];
        for (const NeuronEdge& edge : input.edges) next[edge.to] += edge.weight * from[edge.from];
      }
      for (std::size_t k = 0; k < layer.neurons; ++k) {
        const double alpha = layer.alpha.empty() ? 1 : layer.alpha[layer.alpha.size() == 1 ? 0 : k];
        states_[i][k] += alpha * (activated(layer.activation, next[k]) - states_[i][k]);
      }
    }
    return states_.back();
  }
  const std::vector<double>& state(const std::string& layer) const { return states_[index_.at(layer)]; }

 private:
  static double activated(Activation activation, double sum) {
    switch (activation) {
      case Activation::tanh:
        return std::tanh(sum);
      case Activation::sigmoid:
        return 1 / (1 + std::exp(-sum));
      case Activation::relu:
        return std::max(0.0, sum);
      case Activation::sine:
        return std::sin(sum);
      default:
        return sum;
    }
  }

  Brain brain_;
  std::map<std::string, std::size_t> index_;
  std::vector<std::vector<double>> states_;
};

}  // namespace mercury
