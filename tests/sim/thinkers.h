// SPDX-License-Identifier: Apache-2.0
// Small robots with brains.
#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "bodies.h"
#include "mercury/brain.h"

namespace mercury::test {

// Two muscles that pull a bar from both of its halves.
inline Robot bar() {
  Robot robot = bodies::voxels({.x = 4, .y = 1, .z = 1}, {50, 0.2f, 5, 0});
  robot.materials.push_back(robot.materials[1]);
  for (Spring& spring : robot.springs) {
    const float middle = (robot.masses[spring.a].x + robot.masses[spring.b].x) / 2;
    spring.material = middle < 0.2f ? 1 : 2;
  }
  robot.actuators = {{.name = "front", .materials = {1}}, {.name = "back", .materials = {2}}};
  return robot;
}

inline NeuronInput matrix(std::string from, std::vector<float> weights) {
  return {std::move(from), std::move(weights), {}, 0};
}

// A clock, the strains and the direction of the target go through two layers.
inline Robot thinker() {
  Robot robot = bar();
  robot.sensors = {{.kind = SensorKind::clock, .frequency = 7, .phase = 0.3f},
                   {.kind = SensorKind::strain, .actuator = "front", .gain = 3},
                   {.kind = SensorKind::strain, .actuator = "back", .gain = 3},
                   {.kind = SensorKind::target_direction}};
  Brain& brain = robot.brain.emplace();
  NeuronLayer hidden{.name = "hidden", .neurons = 3, .alpha = {}, .bias = {0.1f, -0.2f, 0.3f}, .inputs = {}};
  std::vector<float> weights;
  for (int i = 0; i < 3 * 7; ++i) weights.push_back(std::sin(static_cast<float>(3 * i + 1)));
  hidden.inputs = {matrix("senses", weights), matrix("hidden", {0.1f, -0.4f, 0, 0.2f, 0.3f, -0.5f, 0.6f, 0, 0.1f})};
  NeuronLayer motor{.name = "motor", .neurons = 2, .alpha = {0.5f}, .bias = {}, .inputs = {}};
  motor.inputs = {matrix("hidden", {1, -1, 0.5f, 0.3f, 0.7f, -0.9f})};
  brain.layers = {hidden, motor};
  return robot;
}

// The same robot with an LSTM of three cells between senses and motors.
inline Robot lstm() {
  Robot robot = thinker();
  float next = 1;
  const auto numbers = [&](std::size_t count) {
    std::vector<float> all;
    for (std::size_t i = 0; i < count; ++i) all.push_back(0.8f * std::sin(next += 3));
    return all;
  };
  const auto layer = [&](const char* name, Activation activation) {
    NeuronLayer made{.name = name, .neurons = 3, .activation = activation, .alpha = {}, .bias = numbers(3)};
    made.inputs = {matrix("senses", numbers(3 * 7)), matrix("hidden", numbers(3 * 3))};
    return made;
  };
  NeuronLayer cell = layer("cell", Activation::tanh);
  cell.gate = "input", cell.keep_layer = "forget";
  NeuronLayer hidden{.name = "hidden", .neurons = 3, .gate = "output", .keep = {0}};
  hidden.inputs = {{.from = "cell", .weights = {}, .edges = {{0, 0, 1}, {1, 1, 1}, {2, 2, 1}}}};
  NeuronLayer motor{.name = "motor", .neurons = 2, .alpha = {0.5f}};
  motor.inputs = {matrix("hidden", numbers(2 * 3))};
  robot.brain->layers = {layer("input", Activation::sigmoid),
                         layer("forget", Activation::sigmoid),
                         layer("output", Activation::sigmoid),
                         cell,
                         hidden,
                         motor};
  return robot;
}

// Gates of every kind: the rest is kept, or a constant, or what a layer itself says; a later layer is g.
inline Robot gated() {
  Robot robot = thinker();
  std::vector<NeuronLayer>& layers = robot.brain->layers;
  layers[0].gate = "late";
  NeuronLayer leaky{.name = "leaky", .neurons = 3, .activation = Activation::linear, .alpha = {0.1f}};
  leaky.keep = {0.9f, 0.5f, 0};
  leaky.inputs = {matrix("senses", std::vector<float>(3 * 7, 0.3f))};
  NeuronLayer own{.name = "own", .neurons = 3, .activation = Activation::sigmoid, .alpha = {0.2f}};
  own.keep_layer = "own";
  own.inputs = {matrix("leaky", {1, 0, 0, 0, 1, 0, 0, 0, 1})};
  NeuronLayer late{.name = "late", .neurons = 3, .activation = Activation::sigmoid, .bias = {-0.5f, 0, 0.5f}};
  late.inputs = {matrix("own", {1, 0, 0.2f, 0, 1, 0, 0.1f, 0, 1})};
  layers[1].keep = {0.25f};
  layers[1].bias = {0.5f, -0.5f};
  const NeuronLayer motor = layers[1];
  layers = {layers[0], leaky, own, late, motor};
  return robot;
}

}  // namespace mercury::test
