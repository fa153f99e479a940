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

}  // namespace mercury::test
