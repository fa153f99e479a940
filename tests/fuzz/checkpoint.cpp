// SPDX-License-Identifier: Apache-2.0
// Checkpoints of runs.
#include "app/recording/checkpoint.h"

#include <cmath>

#include "tests/fuzz/target.h"

namespace mercury::fuzz {
namespace {

std::string checkpoint_of(bool measured, bool recorded, bool own_points = false, bool thinks = false) {
  Robot robot;
  robot.name = "own";
  robot.masses = {{0, 0, 0}, {0.1f, 0, 0}, {0, 0.1f, 0}};
  robot.springs = {{0, 1, 1, 0.1f}, {0, 2, 1, 0.1f}, {1, 2, 2, 0.14f}};
  robot.faces = {{0, 1, 2}};
  if (own_points) {
    robot.mass = {0.5f, 1, 3};
    robot.velocity = {{}, {0, 0, 0.25f}, {0.1f, 0, 0}};
    robot.fixed = {2};
  }
  Robot thinker = robot;  // with a gate and memory
  thinker.actuators = {{.name = "all", .materials = {1}}};
  thinker.sensors = {{.kind = SensorKind::strain, .actuator = "all", .delay = 0.02f}};
  thinker.brain.emplace().layers = {
      {.name = "gate", .neurons = 1, .activation = Activation::sigmoid},
      {.name = "motor", .neurons = 1, .inputs = {{.from = "senses", .weights = {1}}}, .gate = "gate", .keep = {0.5f}}};
  Simulation simulation({.device = {.kind = DeviceKind::cpu, .threads = 1}},
                        std::vector<Robot>{robot, thinks ? thinker : robot});
  simulation.step(30);
  CheckpointNotes notes{.seconds = 1,
                        .settle = 0.01,
                        .strain_limit = 2,
                        .sampled = measured ? 10 : -1,
                        .robots = {{.index = 0, .name = "own", .file = "own.json"}, {.index = 2, .random = "voxel:1"}},
                        .failed = {{.index = 1, .failure = "no"}},
                        .seed = 3};
  if (measured) notes.measures = {{.path = 1, .work = 0.1}, {.highest = -1}};
  if (recorded) notes.recording = {.path = "/a.h5", .unfinished = "/a.h5.1-0.part", .frames = 3};
  const std::string path = scratch_folder() + "/checkpoint-seed.h5";
  save_checkpoint(path, simulation, notes);
  return content_of(path);
}

bool same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

}  // namespace

void check_checkpoint(std::string_view input) {
  const Checkpoint read = load_checkpoint(scratch_file(input, "input-checkpoint.h5"));
  validate(read.configuration);
  std::size_t masses = 0;
  for (const Robot& robot : read.robots) {
    validate(robot);
    masses += robot.masses.size();
  }
  require(read.state.positions.size() == masses && read.state.velocities.size() == masses, "states do not fit robots");
  require(read.notes.robots.size() == read.robots.size(), "names do not fit robots");
  Configuration configuration = read.configuration;
  configuration.device = {.kind = DeviceKind::cpu, .threads = 1};
  Simulation simulation(configuration, read.robots);
  simulation.restore(read.state);
  const std::string path = scratch_folder() + "/checkpoint-again.h5";
  save_checkpoint(path, simulation, read.notes);
  const Checkpoint again = load_checkpoint(path);
  require(again.robots == read.robots, "robots do not read back");
  require(again.notes.robots == read.notes.robots && again.notes.failed == read.notes.failed, "names do not read back");
  require(again.notes.recording == read.notes.recording, "the recording does not read back");
  require(again.notes.measures.size() == read.notes.measures.size(), "measures are lost");
  for (std::size_t i = 0; i < read.notes.measures.size(); ++i)
    require(same(again.notes.measures[i].work, read.notes.measures[i].work), "measures do not read back");
}

std::vector<std::string> checkpoint_seeds() {
  return {checkpoint_of(false, false), checkpoint_of(true, true), checkpoint_of(false, false, true),
          checkpoint_of(true, false, false, true)};
}

}  // namespace mercury::fuzz
