// SPDX-License-Identifier: Apache-2.0
// Small bodies for the tests of recordings, and a file of them.
#pragma once

#include <malloc.h>

#include <filesystem>
#include <string>
#include <vector>

#include "app/recording/recorder.h"
#include "mercury/random_voxel.h"
#include "mercury/simulation.h"

namespace mercury::test {

// From then on the process keeps the memory that it frees. HDF5 asks for megabytes per file that is opened, and the
// system would clear them each time.
inline void keep_freed_memory() {
  mallopt(M_TRIM_THRESHOLD, 1 << 28);
  mallopt(M_MMAP_THRESHOLD, 1 << 25);
}

// Two masses on a muscle.
inline Robot pair(const std::string& name) {
  Robot robot;
  robot.name = name;
  robot.masses = {{0, 0, 0}, {0.1f, 0, 0}};
  robot.springs = {{0, 1, 1, 0.1f}};
  return robot;
}

// Small, with a skin and an origin.
inline Robot small_voxel_robot(std::uint64_t index) {
  return random_voxel_robot({.smallest = {2, 2, 1}, .largest = {3, 2, 2}}, 7, index);
}

// A robot with its own materials, named.
inline Robot own_materials(const std::string& name) {
  Robot robot = pair(name);
  robot.materials = {{}, {30, 0.2f, 3, 0.5f, true}, {70, 0, 0, 0}};
  robot.material_names = {"air", "fast muscle", "cord"};
  robot.actuators = {{"both", {2, 1}}};
  return robot;
}

// A robot that says what its masses are, with materials that relax.
inline Robot own_points(const std::string& name) {
  Robot robot = own_materials(name);
  robot.materials[1].relaxation_time = 0.02f;
  robot.masses.push_back({0, 0.1f, 0});
  robot.springs.push_back({0, 2, 2, 0.1f});
  robot.mass = {0.5f, 1, 3};
  robot.velocity = {{}, {0, 0, 0.25f}, {0.1f, 0, 0}};
  robot.fixed = {2, 0};
  return robot;
}

// Its muscle follows a recurrent net of a clock, the depth and its own strain, 0.004 s at a time.
inline Robot thinking_pair(const std::string& name) {
  Robot robot = pair(name);
  robot.actuators = {{"muscle", {1}}};
  robot.sensors = {{.kind = SensorKind::clock, .frequency = 30, .phase = 0.3f},
                   {.kind = SensorKind::depth},
                   {.kind = SensorKind::strain, .actuator = "muscle", .gain = 20}};
  NeuronLayer hidden{.name = "hidden", .neurons = 2, .alpha = {0.4f}, .bias = {0.1f, -0.2f}, .inputs = {}};
  hidden.inputs = {{"senses", {0.5f, -1, 2, 3, 1, 0.2f, -2, 1}, {}, 0}, {"hidden", {0.1f, -0.7f, 0.8f, 0.2f}, {}, 0}};
  NeuronLayer motor{.name = "motor", .neurons = 1, .alpha = {}, .bias = {}, .inputs = {}};
  motor.inputs = {{"hidden", {1, -0.6f}, {}, 0}};
  robot.brain = Brain{.period = 0.004f, .layers = {hidden, motor}};
  return robot;
}

inline Configuration on_cpu() {
  Configuration configuration;
  configuration.device.kind = DeviceKind::cpu;
  return configuration;
}

// Steps a simulation to `last` and records every `every` steps.
inline void record(Simulation& simulation, const std::filesystem::path& path, std::int64_t last, std::int64_t every,
                   RecordingOptions options = {}) {
  options.every = every;
  options.last_step = last;
  Recorder recorder(simulation, path, options);
  while (simulation.steps() < last) {
    simulation.step(std::min(last, recorder.next_step()) - simulation.steps());
    recorder.observe();
  }
  recorder.finish();
}

}  // namespace mercury::test
