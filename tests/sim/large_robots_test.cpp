// SPDX-License-Identifier: Apache-2.0
// Robots that do not fit on one multiprocessor of a GPU. Clusters of blocks step them in parts where the device has
// them; elsewhere, and if they think, they are in device memory. Neither changes a bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "backend.h"
#include "bodies.h"
#include "thinkers.h"

namespace mercury {
namespace {

class LargeRobots : public EveryPair {
 protected:
  void expect_reproducible(int layers) const;
};

INSTANTIATE_TEST_SUITE_P(All, LargeRobots, every_pair, EveryPair::name);

void LargeRobots::expect_reproducible(int layers) const {
  const std::vector<Robot> robots = {bodies::random_voxels({.x = 2, .y = 2, .z = 2}, 1),
                                     bodies::random_voxels({.x = 17, .y = 17, .z = layers}, 2)};
  Simulation together(configuration(), robots), alone(configuration(), std::span(robots).last(1));
  together.step(60);
  for (int call = 0; call < 60; ++call) alone.step();
  EXPECT_EQ(together.hash(1), alone.hash(0));
  Simulation small(configuration(), std::span(robots).first(1));
  small.step(60);
  EXPECT_EQ(together.hash(0), small.hash(0));
}

// 6,156 masses fit on the largest chips if XPBD keeps the valences in device memory; 8,000 fit on none.
TEST_P(LargeRobots, AreReproducibleOnTheLargestChips) { expect_reproducible(18); }
TEST_P(LargeRobots, AreReproducibleBeyondAnyChip) { expect_reproducible(24); }

// Two halves that hang together at the bottom, so that they collide where the cut is.
Robot cut_block(const Material& material) {
  Robot robot = bodies::voxels({.x = 18, .y = 18, .z = 20}, material);
  std::erase_if(robot.springs, [&](const Spring& spring) {
    const Vec3 a = robot.masses[spring.a], b = robot.masses[spring.b];
    return std::min(a.z, b.z) > 0.15f && (a.x < 0.85f) != (b.x < 0.85f);
  });
  return robot;
}

// The same robot with a brain, which holds the only material at its rest length: as it does by itself.
Robot with_idle_brain(Robot robot) {
  robot.actuators = {{.name = "all", .materials = {1}}};
  robot.sensors = {{.kind = SensorKind::clock, .frequency = 1}};
  NeuronLayer motor{.name = "motor", .neurons = 1, .alpha = {}, .bias = {}, .inputs = {}};
  motor.inputs = {test::matrix("senses", {0, 0})};
  robot.brain.emplace().layers = {motor};
  return robot;
}

// Two robots in the same state: one that is stepped in parts where that is possible, one that never is.
class InParts {
 public:
  InParts(const Configuration& configuration, const Robot& robot)
      : parts_(configuration, std::vector{robot}), whole_(configuration, std::vector{with_idle_brain(robot)}) {
    State state = bodies::shaken(robot, 0.01f, 0.5f, 7);
    for (Vec3& x : state.positions)
      if (x.x > 0.85f) x.x -= 0.04f;
    for (Simulation* simulation : {&parts_, &whole_}) simulation->set_state(0, state.positions, state.velocities);
  }

  template <class Change>
  void both(const Change& change) {
    for (Simulation* simulation : {&parts_, &whole_}) change(*simulation);
  }
  void expect_same(std::int64_t steps) {
    both([&](Simulation& simulation) { simulation.step(steps); });
    const State a = parts_.state(0), b = whole_.state(0);
    EXPECT_EQ(a.positions, b.positions);
    EXPECT_EQ(a.velocities, b.velocities);
    const Telemetry one = parts_.telemetry(0), other = whole_.telemetry(0);
    EXPECT_EQ(one.exploded, other.exploded);
    EXPECT_EQ(one.elastic_energy, other.elastic_energy);
    EXPECT_EQ(one.kinetic_energy, other.kinetic_energy);
    EXPECT_EQ(one.center_of_mass, other.center_of_mass);
  }
  // Whether only the one with a brain is in device memory, as on all devices that have clusters.
  bool differ_in_notes() const {
    const auto in_device_memory = [](const Simulation& simulation) {
      return std::ranges::any_of(
          simulation.notes(), [](const std::string& note) { return note.find("device memory") != std::string::npos; });
    };
    return !in_device_memory(parts_) && in_device_memory(whole_);
  }

 private:
  Simulation parts_, whole_;
};

TEST_P(LargeRobots, InPartsMoveAsWholeOnes) {
  InParts robots(configuration(), cut_block({.stiffness = 60}));
  robots.expect_same(40);
  EXPECT_EQ(robots.differ_in_notes(), configuration().device.kind == DeviceKind::cuda);
  const Perturbation pull{0, 4000, {0.3f, 0.2f, 3}, 900};
  robots.both([&](Simulation& simulation) { simulation.set_perturbations({&pull, 1}); });
  robots.expect_same(20);
  robots.both([&](Simulation& simulation) {
    Configuration other = simulation.configuration();
    other.solver = other.solver == Solver::force ? Solver::xpbd : Solver::force;
    simulation.configure(other);
  });
  robots.expect_same(20);
}

// Compressed so far that the lists of pairs overflow.
TEST_P(LargeRobots, InPartsMoveAsWholeOnesWhereAllMassesTouch) {
  const Robot robot = bodies::voxels({.x = 18, .y = 18, .z = 20}, {.stiffness = 60});
  InParts robots(configuration(), robot);
  State state = bodies::shaken(robot, 0.01f, 0.5f, 7);
  for (Vec3& x : state.positions) x = 0.24f * x;
  robots.both([&](Simulation& simulation) { simulation.set_state(0, state.positions, state.velocities); });
  robots.expect_same(10);
}

TEST_P(LargeRobots, InPartsExplodeAsWholeOnes) {
  const Robot robot = cut_block({.stiffness = 60});
  InParts robots(configuration(), robot);
  State state = bodies::moving(robot, {});
  state.velocities[4321] = {0, 3e5f, 0};
  robots.both([&](Simulation& simulation) { simulation.set_state(0, state.positions, state.velocities); });
  for (int call = 0; call < 4; ++call) robots.expect_same(5);
  robots.both([](Simulation& simulation) { EXPECT_TRUE(simulation.telemetry(0).exploded); });
}

// Masses of their own, fixed masses and viscous springs, in all kinds of water.
class LargeRealBodies : public testing::TestWithParam<std::tuple<DeviceKind, Solver, std::string_view>> {};
INSTANTIATE_TEST_SUITE_P(All, LargeRealBodies,
                         testing::Combine(every_device, testing::Values(Solver::force, Solver::xpbd),
                                          testing::Values("water", "water+contacts", "ocean", "land", "resistive",
                                                          "resistive+contacts")),
                         EveryPair::name);

TEST_P(LargeRealBodies, InPartsMoveAsWholeOnes) {
  const auto [device, solver, environment] = GetParam();
  BackendTest::skip_without(device);
  if (IsSkipped()) return;
  Robot robot = cut_block({.stiffness = 60, .relaxation_time = 0.005f});
  std::mt19937 random(3);
  for (std::size_t i = 0; i < robot.masses.size(); ++i)
    robot.mass.push_back(std::uniform_real_distribution<float>(0.5f, 1.5f)(random));
  robot.fixed = {17, 4000};
  Environment water = environment_named(environment);
  if (environment.starts_with("resistive")) std::get<ResistiveDrag>(water.water).one_sided = true;
  InParts robots({.solver = solver, .environment = water, .device = {.kind = device}}, robot);
  robots.expect_same(40);
  EXPECT_EQ(robots.differ_in_notes(), device == DeviceKind::cuda);
}

}  // namespace
}  // namespace mercury
