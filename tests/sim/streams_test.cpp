// SPDX-License-Identifier: Apache-2.0
// Steps in a CUDA stream are the same steps, and whatever follows them sees their result. On other backends the same
// functions step at once.
#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <thread>

#include "bodies.h"
#include "same_telemetry.h"
#include "shared_batch.h"

namespace mercury {
namespace {

using test::SharedBatch;

// cudaStreamLegacy and cudaStreamPerThread are handles that exist without being made.
void* const legacy_stream = nullptr;
void* const stream_of_thread = reinterpret_cast<void*>(std::uintptr_t{2});

// Of several sizes, so that CUDA puts them into several classes.
std::vector<Robot> streamed_robots() {
  return {bodies::random_voxels({.x = 2, .y = 2, .z = 2}, 1), bodies::random_voxels({.x = 5, .y = 4, .z = 3}, 2),
          bodies::random_voxels({.x = 1, .y = 2, .z = 1}, 3), bodies::pair({50, 0.3f, 4, 1})};
}

class StepsInAStream : public EveryPair {};
INSTANTIATE_TEST_SUITE_P(All, StepsInAStream, every_pair, EveryPair::name);

TEST_P(StepsInAStream, GiveTheHashesOfSteps) {
  const std::vector<Robot> robots = streamed_robots();
  Simulation expected(configuration(), robots), legacy(configuration(), robots), own(configuration(), robots);
  expected.step(200);
  for (int call = 0; call < 10; ++call) {
    legacy.step_in_stream(20, legacy_stream);
    own.step_in_stream(17, call % 2 == 0 ? stream_of_thread : legacy_stream);
    own.step(3);
  }
  EXPECT_EQ(legacy.steps(), 200);
  EXPECT_EQ(legacy.hashes(), expected.hashes());
  EXPECT_EQ(own.hashes(), expected.hashes());
}

class Streams : public test::SharedBatchTest {
 protected:
  // Two batches do the same, one in steps, the other in steps in a stream.
  void expect_same(const std::function<void(Simulation&)>& change) const {
    for (void* const stream : {legacy_stream, stream_of_thread}) {
      const std::vector<Robot> robots = streamed_robots();
      SharedBatch expected = batch({}, robots), actual = batch({}, robots);
      expected->step(40);
      actual->step_in_stream(40, stream);
      change(*expected);
      change(*actual);
      expected->step(40);
      actual->step_in_stream(40, stream);
      EXPECT_EQ(actual->hashes(), expected->hashes());
    }
  }
};
INSTANTIATE_TEST_SUITE_P(All, Streams, test::every_backend, test::SharedBatchTest::name);

TEST_P(Streams, EveryFunctionThatReadsSeesTheSteps) {
  const std::vector<Robot> robots = streamed_robots();
  SharedBatch expected = batch({}, robots), actual = batch({}, robots);
  const auto step = [&] {
    expected->step(15);
    actual->step_in_stream(15, stream_of_thread);
  };
  std::vector<Vec3> a(expected->mass_count()), b(a.size());
  step();
  EXPECT_EQ(actual->positions(1), expected->positions(1));
  step();
  actual->read_positions(a);
  expected->read_positions(b);
  EXPECT_EQ(a, b);
  step();
  actual->read_velocities(a);
  expected->read_velocities(b);
  EXPECT_EQ(a, b);
  for (int call = 0; call < 2; ++call) {
    step();
    const auto telemetry = actual->telemetry(), expected_telemetry = expected->telemetry();
    for (std::size_t i = 0; i < robots.size(); ++i) expect_equal(telemetry[i], expected_telemetry[i]);
  }
  step();
  EXPECT_EQ(batch({}, {}).vectors(actual->shared_state(StateArray::positions)),
            expected.vectors(expected->shared_state(StateArray::positions)));
  step();
  const auto samples = actual->step_and_sample(20, 10), expected_samples = expected->step_and_sample(20, 10);
  for (std::size_t i = 0; i < samples.size(); ++i) expect_equal(samples[i], expected_samples[i]);
}

TEST_P(Streams, EveryChangeComesAfterTheSteps) {
  const std::vector<Robot> more = {bodies::random_voxels({.x = 3, .y = 3, .z = 3}, 5)};
  expect_same([](Simulation& simulation) {
    const State start = bodies::shaken(simulation.robot(1), 0.01f, 0.3f, 1);
    simulation.set_state(1, start.positions, start.velocities);
  });
  expect_same([](Simulation& simulation) { simulation.reset(); });
  expect_same([](Simulation& simulation) { simulation.reset(std::vector<std::uint8_t>{0, 1, 0, 1}); });
  expect_same([](Simulation& simulation) { simulation.set_material(3, 1, {70, 0.1f, 3, 2}); });
  expect_same([](Simulation& simulation) {
    std::vector<Material> materials = simulation.materials();
    for (Material& material : materials) material.phase += 1;
    simulation.set_materials(materials);
  });
  expect_same([](Simulation& simulation) {
    const Perturbation pull{.robot = 1, .mass = 3, .target = {1, 1, 1}, .stiffness = 20};
    simulation.set_perturbations(std::span(&pull, 1));
  });
  expect_same([](Simulation& simulation) {
    Configuration changed = simulation.configuration();
    changed.dt = 7e-4;
    changed.environment = Land{};
    simulation.configure(changed);
  });
  expect_same([&](Simulation& simulation) { simulation.add(more); });
  expect_same([](Simulation& simulation) { simulation.keep(std::array<std::size_t, 3>{3, 0, 1}); });
  expect_same([](Simulation& simulation) { (void)simulation.actuation(); });
}

TEST_P(Streams, AnExplosionOnTheWayIsReported) {
  const std::vector<Robot> robots = streamed_robots();
  SharedBatch batch = this->batch({.environment = empty_space()}, robots);
  State far = batch->state(1);
  far.positions[0].x = 2e6f;
  batch->set_state(1, far.positions, far.velocities);
  batch->step_in_stream(10, nullptr);
  EXPECT_EQ(batch.read(batch->shared_exploded()), (std::vector<std::uint8_t>{0, 1, 0, 0}));
  EXPECT_TRUE(batch->state(1).exploded);
  EXPECT_EQ(batch->telemetry(1).exploded_at, 0);
}

TEST_P(Streams, SeveralThreadsStepBatchesOfTheirOwn) {
  const std::vector<Robot> robots = streamed_robots();
  SharedBatch expected = batch({}, robots);
  expected->step(200);
  std::array<std::vector<std::uint64_t>, 3> hashes;
  {
    std::vector<std::jthread> threads;
    for (auto& own : hashes)
      threads.emplace_back([&] {
        SharedBatch batch = this->batch({}, robots);
        (void)batch->shared_state(StateArray::centers);
        for (int call = 0; call < 20; ++call) batch->step_in_stream(10, stream_of_thread);
        own = batch->hashes();
      });
  }
  for (const auto& own : hashes) EXPECT_EQ(own, expected->hashes());
}

TEST_P(Streams, AreRefusedANegativeNumberOfSteps) {
  SharedBatch batch = this->batch({}, streamed_robots());
  EXPECT_THROW(batch->step_in_stream(-1, nullptr), std::invalid_argument);
}

}  // namespace
}  // namespace mercury
