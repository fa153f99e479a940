// SPDX-License-Identifier: Apache-2.0
#include "robots/brain_genes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "mercury/error.h"
#include "mercury/material.h"
#include "mercury/random.h"
#include "robots/mutation_step.h"

namespace mercury {
namespace {

constexpr double largest_weight = std::numeric_limits<float>::max();

constexpr StepRange steps{BrainGenes::smallest_step, BrainGenes::largest_step};

}  // namespace

BrainGenes BrainGenes::mutated(double strength, std::uint64_t seed) const {
  Random random(seed);
  BrainGenes child = *this;
  child.step = adapted_step(step, weights.size(), steps, random);
  for (float& weight : child.weights)
    weight = limited_weight(static_cast<double>(weight) + strength * child.step * random.normal());
  return child;
}

float BrainGenes::limited_weight(double weight) {
  return static_cast<float>(std::clamp(weight, -largest_weight, largest_weight));
}

BrainGenes BrainGenes::crossed(const BrainGenes& other, const Brain& brain, std::uint64_t seed) const {
  Random random(seed);
  BrainGenes child = *this;
  child.step = crossed_step(step, other.step, steps);
  std::size_t at = 0;
  for (const NeuronLayer& layer : brain.layers) {
    std::vector<bool> from_other;
    for (std::uint32_t neuron = 0; neuron < layer.neurons; ++neuron) from_other.push_back(random.chance(0.5));
    const auto take = [&](std::size_t neuron) {
      if (from_other[neuron]) child.weights[at] = other.weights[at];
      ++at;
    };
    for (std::size_t neuron = 0; neuron < layer.bias.size(); ++neuron) take(neuron);
    for (const NeuronInput& input : layer.inputs) {
      const std::size_t width = input.weights.size() / std::max<std::size_t>(1, layer.neurons);
      for (std::size_t i = 0; i < input.weights.size(); ++i) take(i / width);
      for (const NeuronEdge& edge : input.edges) take(edge.to);
    }
  }
  return child;
}

void BrainGenes::write(ByteWriter& writer) const {
  writer.add(step);
  writer.numbers(weights);
}

BrainGenes BrainGenes::read(ByteReader& reader, std::size_t count) {
  BrainGenes genes;
  genes.step = reader.read<double>();
  if (!(genes.step >= smallest_step && genes.step <= largest_step))
    throw InputError("genome", "the step of its brain's weights is out of range");
  genes.weights = reader.numbers<float>();
  if (genes.weights.size() != count)
    throw InputError("genome",
                     "has " + std::to_string(genes.weights.size()) + " weights, its brain " + std::to_string(count));
  if (!std::ranges::all_of(genes.weights, [](float weight) { return std::isfinite(weight); }))
    throw InputError("genome", "a weight of its brain is not finite");
  return genes;
}

bool same_brain_structure(const Robot& a, const Robot& b) {
  if (!a.brain || !b.brain || a.sensors != b.sensors) return false;
  const std::vector<float> weights = weights_of(*a.brain);
  Brain like_a = *b.brain;
  if (weights_of(like_a).size() != weights.size()) return false;
  set_weights(like_a, weights);
  return like_a == *a.brain;
}

void give_brain_per_actuator(Robot& robot, float clock_frequency) {
  constexpr std::uint32_t hidden = 4;
  constexpr std::size_t senses = 1 + 2 + 2 + 3;
  const auto sensor = [](SensorKind kind) {
    Sensor made;
    made.kind = kind;
    return made;
  };
  Sensor strain = sensor(SensorKind::strain), clock = sensor(SensorKind::clock);
  strain.actuator = "self";
  strain.gain = 5;  // strains are about 0.1
  clock.frequency = clock_frequency;
  robot.sensors = {strain, sensor(SensorKind::neighbors), clock, sensor(SensorKind::target_direction)};
  const auto layer = [](const char* name, std::uint32_t neurons, const char* from, std::size_t width) {
    NeuronLayer made;
    made.name = name;
    made.neurons = neurons;
    made.bias.assign(neurons, 0);
    NeuronInput& input = made.inputs.emplace_back();
    input.from = from;
    input.weights.assign(neurons * width, 0);
    return made;
  };
  Brain& brain = robot.brain.emplace();
  brain.per_actuator = true;
  brain.layers = {layer("hidden", hidden, "senses", senses), layer("motor", 1, "hidden", hidden)};
}

void give_layer_of_outputs(Robot& robot) {
  NeuronLayer& layer = robot.brain.emplace().layers.emplace_back();
  layer.name = "motor";
  layer.neurons = static_cast<std::uint32_t>(actuators_of(robot).size());
  layer.bias.assign(layer.neurons, 0);
}

BrainGenes random_brain_genes(const Brain& brain, std::uint64_t seed) {
  Random random(seed);
  BrainGenes genes{.weights = weights_of(brain)};
  for (float& weight : genes.weights) weight = static_cast<float>(random.normal());
  return genes;
}

float mean_muscle_frequency(const Robot& robot) {
  const std::vector<Actuator> actuators = actuators_of(robot);
  constexpr float of_default_muscles = 3;  // 1 to 5 rad/s
  double sum = 0, count = 0;
  for (const Actuator& actuator : actuators) {
    sum += static_cast<double>(materials_of(robot)[actuator.materials.front()].frequency);
    ++count;
  }
  return sum > 0 ? static_cast<float>(sum / count) : of_default_muscles;
}

}  // namespace mercury
