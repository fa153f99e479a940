// SPDX-License-Identifier: Apache-2.0
// Robots that are added to and removed from a running batch, and telemetry sampled while stepping: on every backend,
// on several backends as one, and on a backend that has only the defaults.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>

#include "backend.h"
#include "bodies.h"
#include "plain_backend.h"
#include "same_telemetry.h"
#include "tests/refusal.h"

namespace mercury {
namespace {

std::unique_ptr<Backend> split_over_three() {
  std::vector<std::unique_ptr<Backend>> parts;
  for (int part = 0; part < 3; ++part) parts.push_back(make_cpu_backend({}));
  return make_split_backend(std::move(parts));
}

struct Maker {
  std::string_view name;
  std::function<std::unique_ptr<Backend>()> make;
};
using Case = std::tuple<Maker, Solver, std::string_view>;

class BatchEdits : public testing::TestWithParam<Case> {
 protected:
  void SetUp() override {
    if (std::get<Maker>(GetParam()).name == "cuda") BackendTest::skip_without(DeviceKind::cuda);
  }
  Configuration configuration() const {
    return {.solver = std::get<Solver>(GetParam()),
            .environment = environment_named(std::get<std::string_view>(GetParam()))};
  }
  Simulation start(std::span<const Robot> robots) const {
    return Simulation(configuration(), robots, std::get<Maker>(GetParam()).make());
  }
  std::vector<std::uint64_t> hashes_after(std::span<const Robot> robots, std::int64_t steps) const {
    Simulation simulation = start(robots);
    simulation.step(steps);
    return simulation.hashes();
  }

 public:
  static std::string name(const testing::TestParamInfo<Case>& info) {
    std::string text(std::get<Maker>(info.param).name);
    text.append(1, '_').append(name_of(std::get<Solver>(info.param))).append(1, '_');
    for (const char letter : std::get<std::string_view>(info.param))
      text += letter == '-' || letter == '+' ? '_' : letter;
    return text;
  }
};
INSTANTIATE_TEST_SUITE_P(
    All, BatchEdits,
    testing::Combine(testing::Values(Maker{"cpu", [] { return make_cpu_backend({}); }},
                                     Maker{"cuda", [] { return make_cuda_backend({.kind = DeviceKind::cuda}); }},
                                     Maker{"split", split_over_three},
                                     Maker{"defaults", [] { return std::make_unique<test::PlainBackend>(); }}),
                     testing::Values(Solver::force, Solver::xpbd), testing::ValuesIn(tested_environments)),
    BatchEdits::name);

// Some alike, some of their own, so that some step in lockstep and some alone.
std::vector<Robot> herd(std::size_t size = 24) {
  std::vector<Robot> robots;
  for (std::uint64_t seed = 0; seed < size; ++seed)
    robots.push_back(bodies::random_voxels({.x = seed % 4 == 0 ? 1 + static_cast<int>(seed) % 3 : 2}, seed));
  return robots;
}
// Shaken, so that robots differ from those at rest. On land they stand on the floor.
void shake(Simulation& simulation, std::size_t robot) {
  const State now = simulation.state(robot);
  State shaken = bodies::shaken(simulation.robot(robot), 0.002f, 0.3f, robot);
  for (std::size_t i = 0; i < shaken.positions.size(); ++i)
    shaken.positions[i] += now.positions[i] - simulation.robot(robot).masses[i];
  simulation.set_state(robot, shaken);
}
const Perturbation pull{.robot = 3, .mass = 1, .target = {1, 2, 3}, .stiffness = 10};

TEST_P(BatchEdits, AddedRobotsMoveAsIfTheyHadStartedAlone) {
  const std::vector<Robot> robots = herd();
  Simulation simulation = start(std::span(robots).first(10));
  simulation.step(30);
  EXPECT_EQ(simulation.add(robots[10]), 10u);
  EXPECT_EQ(simulation.add(std::span(robots).subspan(11)), 11u);
  simulation.set_clock({.dt = configuration().dt});  // the new ones' muscles are at time 0
  simulation.step(40);
  const std::vector<std::uint64_t> hashes = simulation.hashes();
  const std::vector<std::uint64_t> expected = hashes_after(robots, 40);
  for (std::size_t i = 10; i < robots.size(); ++i) EXPECT_EQ(hashes[i], expected[i]) << i;
}

TEST_P(BatchEdits, AnAddedRobotChangesNothingForTheOthers) {
  const std::vector<Robot> robots = herd();
  const Material soft{.stiffness = 20, .amplitude = 0.1f, .frequency = 3};
  Simulation alone = start(std::span(robots).first(20)), edited = start(std::span(robots).first(20));
  for (Simulation* simulation : {&alone, &edited}) {
    for (std::size_t i = 0; i < 20; ++i) shake(*simulation, i);
    simulation->set_material(2, 5, soft);
    simulation->set_perturbations({&pull, 1});
    simulation->step(20);
  }
  edited.add(std::span(robots).subspan(20));
  edited.add(robots[0]);
  for (Simulation* simulation : {&alone, &edited}) simulation->step(50);
  const std::vector<std::uint64_t> hashes = edited.hashes(), expected = alone.hashes();
  for (std::size_t i = 0; i < 20; ++i) EXPECT_EQ(hashes[i], expected[i]) << i;
  EXPECT_EQ(edited.material(2, 5), soft);
  EXPECT_EQ(edited.material(20, 5), default_materials()[5]);
}

TEST_P(BatchEdits, KeptRobotsMoveAsIfAllHadStayed) {
  const std::vector<Robot> robots = herd();
  const Material soft{.stiffness = 20, .amplitude = 0.1f, .frequency = 3};
  Simulation alone = start(robots), edited = start(robots);
  for (Simulation* simulation : {&alone, &edited}) {
    for (std::size_t i = 0; i < robots.size(); ++i) shake(*simulation, i);
    simulation->set_material(7, 5, soft);
    simulation->step(20);
    simulation->set_perturbations({&pull, 1});
  }
  const std::vector<std::size_t> kept{23, 0, 1, 2, 7, 9, 3, 12, 13, 4, 5};
  edited.keep(kept);
  alone.set_perturbations({});
  for (Simulation* simulation : {&alone, &edited}) simulation->step(50);
  const std::vector<std::uint64_t> hashes = edited.hashes(), expected = alone.hashes();
  ASSERT_EQ(hashes.size(), kept.size());
  for (std::size_t i = 0; i < kept.size(); ++i) {
    EXPECT_EQ(hashes[i], expected[kept[i]]) << kept[i];
    EXPECT_EQ(edited.robot(i), robots[kept[i]]);
  }
  EXPECT_EQ(edited.material(4, 5), soft);
}

TEST_P(BatchEdits, ARemovedRobotChangesNothingForTheOthers) {
  const std::vector<Robot> robots = herd(80);
  Simulation alone = start(robots), edited = start(robots);
  for (Simulation* simulation : {&alone, &edited}) simulation->step(10);
  std::vector<std::size_t> kept(robots.size());
  for (std::size_t i = 0; i < kept.size(); ++i) kept[i] = i;
  for (const std::ptrdiff_t gone : {31, 0}) {  // with a step in between, and then with an addition before the step
    kept.erase(kept.begin() + gone);
    std::vector<std::size_t> indices(edited.size());
    for (std::size_t i = 0; i < indices.size(); ++i) indices[i] = i;
    indices.erase(indices.begin() + gone);
    edited.keep(indices);
    if (gone == 0) edited.add(robots[0]);
    for (Simulation* simulation : {&alone, &edited}) simulation->step(10);
  }
  const std::vector<std::uint64_t> hashes = edited.hashes(), expected = alone.hashes();
  ASSERT_EQ(hashes.size(), kept.size() + 1);
  for (std::size_t i = 0; i < kept.size(); ++i) EXPECT_EQ(hashes[i], expected[kept[i]]) << kept[i];
}

// Generation after generation: the worst go, children come, and every robot still moves as it would alone.
TEST_P(BatchEdits, ManyGenerationsLeaveTheElderUntouched) {
  const std::vector<Robot> robots = herd();
  Simulation alone = start(std::span(robots).first(1)), edited = start(std::span(robots).first(8));
  std::vector<std::size_t> kept{0, 1, 2, 3, 4};
  for (std::size_t generation = 0; generation < 5; ++generation) {
    for (Simulation* simulation : {&alone, &edited}) simulation->step(10);
    std::rotate(kept.begin(), kept.begin() + 1, kept.end());  // robot 0 gets another index each time
    const auto elder = static_cast<std::size_t>(std::ranges::find(kept, std::size_t{0}) - kept.begin());
    edited.keep(kept);
    edited.add(std::span(robots).subspan(8 + 3 * generation, 3));
    EXPECT_EQ(edited.hash(elder), alone.hash(0)) << generation;
    std::vector<std::size_t> front(edited.size());
    for (std::size_t i = 0; i < front.size(); ++i) front[i] = i;
    std::swap(front[0], front[elder]);
    edited.keep(front);
  }
  alone.step(30);
  edited.step(30);
  EXPECT_EQ(edited.hash(0), alone.hash(0));
}

TEST_P(BatchEdits, AllRobotsCanGoAndOthersCome) {
  const std::vector<Robot> robots = herd();
  Simulation simulation = start(robots);
  simulation.step(5);
  simulation.add(robots[3]);
  simulation.keep(std::array<std::size_t, 1>{robots.size()});
  simulation.keep({});
  simulation.step(5);
  EXPECT_TRUE(simulation.hashes().empty());
  EXPECT_TRUE(simulation.step_and_sample(10, 5).empty());
  EXPECT_EQ(simulation.steps(), 20);
  simulation.add(robots);
  simulation.set_clock({.dt = configuration().dt});
  simulation.step(20);
  EXPECT_EQ(simulation.hashes(), hashes_after(robots, 20));
}

TEST_P(BatchEdits, AfterAResetRobotsMoveAsFromTheStart) {
  const std::vector<Robot> robots = herd();
  Simulation simulation = start(std::span(robots).first(10));
  State far = simulation.state(4);
  far.positions[2].x = 2e6f;
  simulation.set_state(4, far.positions, far.velocities);
  simulation.step(10);
  simulation.add(std::span(robots).subspan(10));
  simulation.keep(std::array<std::size_t, 5>{20, 4, 7, 8, 11});
  simulation.step(10);
  simulation.reset();
  simulation.step(30);
  const std::vector<std::uint64_t> expected =
      hashes_after(std::vector{robots[20], robots[4], robots[7], robots[8], robots[11]}, 30);
  EXPECT_EQ(simulation.hashes(), expected);
}

TEST_P(BatchEdits, ExplosionsSurvive) {
  const std::vector<Robot> robots = herd();
  Simulation simulation = start(std::span(robots).first(20));
  simulation.step(5);
  State far = simulation.state(4);
  far.positions[2].x = 2e6f;
  simulation.set_state(4, far.positions, far.velocities);
  simulation.step(5);
  const Telemetry before = simulation.telemetry(4);
  const std::uint64_t frozen = simulation.hash(4);
  ASSERT_TRUE(before.exploded);
  simulation.add(robots[20]);
  simulation.step(5);
  EXPECT_EQ(simulation.telemetry(4).exploded_at, before.exploded_at);
  EXPECT_EQ(simulation.hash(4), frozen);
  simulation.keep(std::array<std::size_t, 4>{20, 4, 7, 8});
  simulation.step(5);
  EXPECT_EQ(simulation.hash(1), frozen);
  const std::vector<Telemetry> after = simulation.telemetry();
  EXPECT_EQ(after[1].exploded_at, before.exploded_at);
  EXPECT_EQ(after[1].culprit_spring, before.culprit_spring);
  for (const std::size_t i : {0u, 2u, 3u}) EXPECT_FALSE(after[i].exploded) << i;
}

TEST_P(BatchEdits, SamplesAreThoseOfStepAndTelemetryInTurn) {
  const std::vector<Robot> robots = herd();
  Simulation in_turn = start(robots), sampled = start(robots);
  for (Simulation* simulation : {&in_turn, &sampled}) {
    simulation->step(3);
    State fast = simulation->state(2);
    fast.velocities[0].y = 3e7f;  // explodes in the second or third portion
    simulation->set_state(2, fast.positions, fast.velocities);
  }
  const std::vector<Telemetry> samples = sampled.step_and_sample(60, 15);
  ASSERT_EQ(samples.size(), 4 * robots.size());
  for (std::size_t portion = 0; portion < 4; ++portion) {
    in_turn.step(15);
    const std::vector<Telemetry> expected = in_turn.telemetry();
    for (std::size_t i = 0; i < robots.size(); ++i) expect_equal(samples[portion * robots.size() + i], expected[i]);
  }
  EXPECT_TRUE(samples.back().exploded == false && samples[3 * robots.size() + 2].exploded);
  EXPECT_EQ(sampled.steps(), in_turn.steps());
  EXPECT_EQ(sampled.hashes(), in_turn.hashes());
}

TEST_P(BatchEdits, SamplesFromNowBeginWithTelemetry) {
  const std::vector<Robot> robots = herd();
  for (const std::int64_t steps : {0, 15, 400}) {  // 400 samples come in two portions
    Simulation plain = start(robots), sampled = start(robots);
    for (Simulation* simulation : {&plain, &sampled}) simulation->step(7);
    std::vector<Telemetry> expected = plain.telemetry(), found;
    const auto append = [](std::vector<Telemetry>& to) {
      return [&](std::span<const Telemetry> samples) { to.insert(to.end(), samples.begin(), samples.end()); };
    };
    plain.step_and_sample(steps, 1, append(expected));
    sampled.step_and_sample(steps, 1, append(found), true);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) expect_equal(found[i], expected[i]);
    EXPECT_EQ(sampled.steps(), plain.steps());
    EXPECT_EQ(sampled.hashes(), plain.hashes());
  }
}

TEST_P(BatchEdits, SamplesNeedAWholeNumberOfPortions) {
  const std::vector<Robot> robots = herd();
  Simulation simulation = start(robots);
  EXPECT_THROW(simulation.step_and_sample(10, 3), std::invalid_argument);
  EXPECT_THROW(simulation.step_and_sample(10, 0), std::invalid_argument);
  EXPECT_THROW(simulation.step_and_sample(-3, 3), std::invalid_argument);
  EXPECT_TRUE(simulation.step_and_sample(0, 3).empty());
  EXPECT_EQ(simulation.steps(), 0);
}

TEST_P(BatchEdits, HashesAreThoseOfEachRobot) {
  const std::vector<Robot> robots = herd();
  Simulation simulation = start(robots);
  simulation.step(10);
  const std::vector<std::uint64_t> hashes = simulation.hashes();
  ASSERT_EQ(hashes.size(), robots.size());
  for (std::size_t i = 0; i < robots.size(); ++i) EXPECT_EQ(hashes[i], simulation.hash(i));
}

TEST(SharedRobots, AreNotCopiedAndMoveLikeCopies) {
  const std::vector<Robot> robots(3, bodies::random_voxels({.x = 2, .y = 2, .z = 2}, 1));
  const auto one = std::make_shared<const Robot>(robots[0]);
  const std::vector<std::shared_ptr<const Robot>> thrice(3, one);
  Simulation shared({}, thrice), copied({}, robots);
  shared.add(std::span(thrice).first(1));
  EXPECT_EQ(&shared.robot(0), one.get());
  EXPECT_EQ(&shared.robot(3), one.get());
  for (Simulation* simulation : {&shared, &copied}) simulation->step(20);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(shared.hashes()[i], copied.hashes()[i]);
}

TEST(SharedRobots, TheFirstOfSeveralBadRobotsIsNamed) {
  Robot bad = bodies::random_voxels({.x = 1, .y = 1, .z = 1}, 1);
  bad.springs[4].b = 900;
  std::vector<Robot> robots(50, bodies::random_voxels({.x = 1, .y = 1, .z = 1}, 1));
  for (const std::size_t i : {20, 37, 44}) robots[i] = bad;
  Simulation simulation;
  EXPECT_EQ(refusal([&] { simulation.add(robots); }),
            "robot 20 (random voxels): /springs/4: mass 900 is out of range, the robot has 8");
  EXPECT_EQ(simulation.size(), 0u);
}

}  // namespace
}  // namespace mercury
