// SPDX-License-Identifier: Apache-2.0
// On one backend a robot's trajectory is bit for bit the same from run to run, alone or in any batch, in any order,
// with any number of threads, and however the steps are split into calls.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "backend.h"
#include "bodies.h"

namespace mercury {
namespace {

class Reproducibility : public EveryPair {
 protected:
  static constexpr std::int64_t steps = 400;

  // Robots of many sizes, dropped or shaken.
  static std::vector<Robot> crowd() {
    std::vector<Robot> robots;
    std::uint64_t seed = 1;
    for (const auto& [x, y, z] :
         {std::array{1, 1, 1}, {5, 5, 5}, {2, 3, 1}, {4, 4, 4}, {9, 8, 7}, {3, 3, 3}, {1, 2, 6}}) {
      robots.push_back(bodies::random_voxels({.x = x, .y = y, .z = z}, seed));
      bodies::rotate(robots.back(), bodies::random_rotation(seed++));
    }
    robots.push_back(bodies::pair({50, 0.5f, 3, 0.2f}));
    robots.push_back(bodies::point({0, 0, 1}));
    return robots;
  }

  // One hash per robot after `steps`, in the order of `robots`.
  static std::vector<std::uint64_t> run(const Configuration& configuration, std::span<const Robot> robots,
                                        std::int64_t steps_a_call = steps) {
    Simulation simulation(configuration, robots);
    for (std::size_t i = 0; i < robots.size(); ++i) {
      State start = bodies::shaken(robots[i], 0.01f, 0.3f, 7);
      const float lowest = std::ranges::min(start.positions, {}, &Vec3::z).z;
      for (Vec3& x : start.positions) x.z += 0.05f - lowest;
      simulation.set_state(i, start.positions, start.velocities);
    }
    for (std::int64_t done = 0; done < steps; done += steps_a_call)
      simulation.step(std::min(steps_a_call, steps - done));
    std::vector<std::uint64_t> hashes;
    for (std::size_t i = 0; i < robots.size(); ++i) {
      hashes.push_back(simulation.hash(i));
      EXPECT_FALSE(simulation.telemetry(i).exploded) << i;
    }
    return hashes;
  }
};
INSTANTIATE_TEST_SUITE_P(All, Reproducibility, every_pair, EveryPair::name);

TEST_P(Reproducibility, HashesAreTheSameTwiceAndDifferentForDifferentRobots) {
  const auto robots = crowd();
  auto hashes = run(configuration(), robots);
  EXPECT_EQ(run(configuration(), robots), hashes);
  std::ranges::sort(hashes);
  EXPECT_TRUE(std::ranges::adjacent_find(hashes) == hashes.end());
}

TEST_P(Reproducibility, OneThreadGivesTheHashesOfMany) {
  const auto robots = crowd();
  Configuration one = configuration(), many = configuration();
  one.device.threads = 1;
  many.device.threads = 5;
  EXPECT_EQ(run(one, robots), run(configuration(), robots));
  EXPECT_EQ(run(many, robots), run(configuration(), robots));
}

TEST_P(Reproducibility, ARobotAloneMovesAsInTheBatch) {
  const auto robots = crowd();
  const auto hashes = run(configuration(), robots);
  for (std::size_t i = 0; i < robots.size(); ++i)
    EXPECT_EQ(run(configuration(), std::span(robots).subspan(i, 1)).front(), hashes[i]) << i;
}

// A GPU steps several of them in a block, with a common table of materials or with one for each robot. One explodes.
TEST_P(Reproducibility, OneOfManySmallRobotsMovesAsAlone) {
  constexpr std::int64_t few_steps = 100;
  const Robot small = bodies::random_voxels({.x = 2, .y = 2, .z = 2}, 3);
  const Robot larger = bodies::random_voxels({.x = 5, .y = 5, .z = 5}, 4);
  for (const bool own_materials : {false, true}) {
    std::vector<Robot> robots(600, small);
    robots.insert(robots.end(), 300, larger);
    for (std::size_t i = 0; i < robots.size() && own_materials; ++i) {
      robots[i].materials.assign(materials_of(robots[i]).begin(), materials_of(robots[i]).end());
      for (Material& material : robots[i].materials) material.phase += 0.01f * static_cast<float>(i);
    }
    const auto states_of = [&](std::span<const std::size_t> chosen, std::size_t first, std::size_t count) {
      Simulation simulation(configuration(), std::span(robots).subspan(first, count));
      for (std::size_t i = 0; i < count; ++i) {
        State start = bodies::shaken(robots[first + i], 0.02f, 0.3f, first + i);
        for (Vec3& x : start.positions) x.z += 0.05f;
        if (first + i == 17) start.velocities[5].x = 1e10f;
        simulation.set_state(i, start.positions, start.velocities);
      }
      simulation.step(few_steps / 2);
      simulation.step(few_steps / 2);
      std::vector<std::pair<std::uint64_t, bool>> states;
      for (const std::size_t i : chosen)
        states.emplace_back(simulation.hash(i - first), simulation.telemetry(i - first).exploded);
      return states;
    };
    const std::array<std::size_t, 11> chosen{0, 1, 16, 17, 18, 301, 599, 600, 601, 744, 899};
    const auto together = states_of(chosen, 0, robots.size());
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      EXPECT_EQ(states_of(std::span(chosen).subspan(i, 1), chosen[i], 1).front(), together[i]) << chosen[i];
      EXPECT_EQ(together[i].second, chosen[i] == 17) << chosen[i];
    }
  }
}

// Neighbors in a block then differ in how many contacts they list on land: none, some, or more than there is room for.
TEST_P(Reproducibility, OneOfManyRobotsThatArePressedTogetherMovesAsAlone) {
  const std::vector<Robot> robots(300, bodies::random_voxels({.x = 4, .y = 4, .z = 4}, 4));
  const auto states_of = [&](std::size_t first, std::size_t count) {
    Simulation simulation(configuration(), std::span(robots).subspan(first, count));
    for (std::size_t i = 0; i < count; ++i) {
      State start = bodies::shaken(robots[first + i], 0.005f, 0.1f, first + i);
      const float pressed = std::array{1.0f, 0.6f, 0.25f}[(first + i) % 3];
      for (Vec3& x : start.positions) x = pressed * x + Vec3{0, 0, 0.1f};
      simulation.set_state(i, start.positions, start.velocities);
    }
    for (int call = 0; call < 2; ++call) simulation.step(10);
    std::vector<std::pair<std::uint64_t, bool>> states;
    for (std::size_t i = 0; i < count; ++i) states.emplace_back(simulation.hash(i), simulation.telemetry(i).exploded);
    return states;
  };
  const auto together = states_of(0, robots.size());
  for (const std::size_t i : {0, 1, 2, 149, 150, 151, 297, 298, 299})
    EXPECT_EQ(states_of(i, 1).front(), together[i]) << i;
}

// Lists of contacts outlive a call, so those of the last state must not serve a new one.
TEST_P(Reproducibility, RobotsThatAreSetToANewStateMoveAsNewOnes) {
  for (const std::int32_t size : {4, 8, 12}) {
    const std::vector<Robot> robots(3, bodies::random_voxels({.x = size, .y = size, .z = size}, 4));
    const auto press = [&](Simulation& simulation) {
      for (std::size_t i = 0; i < robots.size(); ++i) {
        State start = bodies::shaken(robots[i], 0.005f, 0.1f, i);
        for (Vec3& x : start.positions) x = 0.6f * x + Vec3{0, 0, 0.1f};
        simulation.set_state(i, start.positions, start.velocities);
      }
    };
    Simulation used(configuration(), robots);
    State failing = bodies::moving(robots[1], {});
    failing.velocities[5].x = 1e10f;
    used.set_state(1, failing.positions, failing.velocities);
    used.step(10);
    EXPECT_TRUE(used.telemetry(1).exploded);
    Simulation made(configuration(), robots);
    made.set_clock(used.clock());
    for (Simulation* simulation : {&used, &made}) {
      press(*simulation);
      for (int call = 0; call < 2; ++call) simulation->step(5);
    }
    for (std::size_t i = 0; i < robots.size(); ++i) EXPECT_EQ(used.hash(i), made.hash(i)) << size << ", " << i;
  }
}

TEST_P(Reproducibility, TheOrderOfTheBatchDoesNotMatter) {
  auto robots = crowd();
  auto hashes = run(configuration(), robots);
  std::ranges::reverse(robots);
  std::ranges::reverse(hashes);
  EXPECT_EQ(run(configuration(), robots), hashes);
  std::rotate(robots.begin(), robots.begin() + 3, robots.end());
  std::rotate(hashes.begin(), hashes.begin() + 3, hashes.end());
  EXPECT_EQ(run(configuration(), robots), hashes);
}

TEST_P(Reproducibility, ManyCallsGiveTheHashesOfOne) {
  const auto robots = crowd();
  const auto hashes = run(configuration(), robots);
  EXPECT_EQ(run(configuration(), robots, 1), hashes);
  EXPECT_EQ(run(configuration(), robots, 7), hashes);
  EXPECT_EQ(run(configuration(), robots, 256), hashes);
}

TEST_P(Reproducibility, RobotsAddedToARunningBatchDoNotDisturbIt) {
  const auto robots = crowd();
  Simulation alone(configuration(), std::span(robots).first(4));
  Simulation joined(configuration(), std::span(robots).first(4));
  alone.step(100);
  joined.step(100);
  EXPECT_EQ(joined.add(std::span(robots).subspan(4)), 4u);
  alone.step(100);
  joined.step(100);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(joined.hash(i), alone.hash(i)) << i;
}

TEST_P(Reproducibility, ResetStartsTheSameTrajectoryAgain) {
  const auto robots = crowd();
  Simulation simulation(configuration(), robots);
  simulation.step(123);
  std::vector<std::uint64_t> first;
  for (std::size_t i = 0; i < robots.size(); ++i) first.push_back(simulation.hash(i));
  simulation.step(77);
  simulation.reset();
  EXPECT_EQ(simulation.time(), 0);
  EXPECT_EQ(simulation.steps(), 0);
  simulation.step(123);
  for (std::size_t i = 0; i < robots.size(); ++i) EXPECT_EQ(simulation.hash(i), first[i]) << i;
}

TEST_P(Reproducibility, AStateReadAndSetAgainContinuesBitForBit) {
  const Robot robot = bodies::voxels({.x = 3, .y = 3, .z = 3}, {60, 0, 0, 0});
  Simulation whole(configuration(), {&robot, 1});
  const State start = bodies::shaken(robot, 0.01f, 0.3f, 9);
  whole.set_state(0, start.positions, start.velocities);
  whole.step(100);
  Simulation continued(configuration(), {&robot, 1});
  const State middle = whole.state(0);
  continued.set_state(0, middle.positions, middle.velocities);
  whole.step(100);
  continued.step(100);
  EXPECT_EQ(continued.hash(0), whole.hash(0));
}

// A run during which everything changes: the second half of the robots comes later; solver, environment and time step
// change, the materials of all robots and of one; one robot is perturbed for a while, two explode, and all is reset.
class EventfulRun {
 public:
  // Runs the robots `which` of `all`. Those in the first half of `all` are there from the start.
  EventfulRun(const Configuration& configuration, std::span<const Robot> all, const std::vector<std::size_t>& which)
      : configuration_(configuration), all_(all), simulation_(configuration) {
    for (const std::size_t robot : which) (robot < all.size() / 2 ? first_ : later_).push_back(robot);
    add(first_);
  }

  // For each robot, its hash and whether it has exploded after every part of the run.
  std::map<std::size_t, std::vector<std::uint64_t>> results() {
    run(60);
    configuration_.dt = 5e-4;
    configuration_.damping = 0.3;
    configuration_.solver = configuration_.solver == Solver::force ? Solver::xpbd : Solver::force;
    simulation_.configure(configuration_);
    run(50);
    add(later_);
    run(40);
    configuration_.environment = Land{};
    simulation_.configure(configuration_);
    run(40);
    configuration_.environment = Ocean{.density = 800, .flow = {0.1f, 0, 0}};
    simulation_.configure(configuration_);
    std::vector<Material> tables = simulation_.materials();
    for (Material& material : tables)
      if (material.stiffness > 0) material = {material.stiffness + 5, 0.1f, material.frequency + 0.5f, 0.3f};
    simulation_.set_materials(tables);
    run(40);
    if (const auto at = place(2)) simulation_.set_material(*at, 7, {90, 0.05f, 3, 0});
    run(40);
    if (const auto at = place(3)) {
      const Perturbation perturbation{*at, 4, {0.3f, 0.2f, 0.1f}, 60};
      simulation_.set_perturbations({&perturbation, 1});
    }
    run(40);
    simulation_.set_perturbations({});
    for (const std::size_t victim : {4u, 21u})
      if (const auto at = place(victim)) {
        State state = simulation_.state(*at);
        state.velocities[1] += Vec3{0, 2e7f, 0};
        simulation_.set_state(*at, state.positions, state.velocities);
      }
    run(40);
    run(3);
    simulation_.reset();
    run(40);
    return hashes_;
  }

 private:
  void add(const std::vector<std::size_t>& robots) {
    for (const std::size_t robot : robots) {
      order_.push_back(robot);
      simulation_.add(all_[robot]);
    }
  }
  std::optional<std::size_t> place(std::size_t robot) const {
    const auto found = std::ranges::find(order_, robot);
    return found == order_.end() ? std::nullopt : std::optional(static_cast<std::size_t>(found - order_.begin()));
  }
  void run(std::int64_t steps) {
    simulation_.step(steps);
    for (std::size_t i = 0; i < order_.size(); ++i) {
      hashes_[order_[i]].push_back(simulation_.hash(i));
      hashes_[order_[i]].push_back(simulation_.telemetry(i).exploded);
    }
  }

  Configuration configuration_;
  std::span<const Robot> all_;
  Simulation simulation_;
  std::vector<std::size_t> first_, later_, order_;
  std::map<std::size_t, std::vector<std::uint64_t>> hashes_;
};

// Most robots have the same topology, because backends group such robots.
TEST_P(Reproducibility, WhateverChangesWhileRunningARobotAloneMovesAsInTheBatch) {
  std::vector<Robot> robots;
  for (std::uint64_t i = 0; i < 44; ++i)
    robots.push_back(bodies::random_voxels({.x = 2, .y = i % 11 == 10 ? 3 : 2, .z = 1}, i));
  std::vector<std::size_t> which(robots.size());
  std::iota(which.begin(), which.end(), std::size_t{0});
  Configuration setting = configuration();
  setting.device.threads = 1;
  const auto expected = EventfulRun(setting, robots, which).results();
  EXPECT_TRUE(std::ranges::count(expected.at(4), 1u) == 2 && std::ranges::count(expected.at(21), 1u) == 2)
      << "exploded after two parts of the run";
  EXPECT_EQ(std::ranges::count(expected.at(5), 1u), 0);
  setting.device.threads = 3;
  std::ranges::reverse(which);
  EXPECT_EQ(EventfulRun(setting, robots, which).results(), expected);
  for (const std::size_t robot : {0u, 2u, 3u, 4u, 5u, 10u, 21u, 22u, 32u, 43u})
    EXPECT_EQ(EventfulRun(setting, robots, {robot}).results().at(robot), expected.at(robot)) << robot;
}

}  // namespace
}  // namespace mercury
