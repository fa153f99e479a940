// SPDX-License-Identifier: Apache-2.0
// Arrays that programs share with a simulation show the state after every step and change.
#include "mercury/shared_array.h"

#include <gtest/gtest.h>

#include <array>

#include "bodies.h"
#include "shared_batch.h"

namespace mercury {
namespace {

using test::SharedBatch;

class SharedArrays : public test::SharedBatchTest {};
INSTANTIATE_TEST_SUITE_P(All, SharedArrays, test::every_backend, test::SharedBatchTest::name);

// Of several sizes, so that CUDA puts them into several classes, and not sorted by size.
std::vector<Robot> crowd() {
  std::vector<Robot> robots = {bodies::random_voxels({.x = 2, .y = 2, .z = 2}, 1), bodies::point({1, 2, 3}),
                               bodies::random_voxels({.x = 5, .y = 4, .z = 3}, 2),
                               bodies::random_voxels({.x = 2, .y = 3, .z = 2}, 3), bodies::pair({50, 0.3f, 4, 1})};
  bodies::rotate(robots[3], bodies::random_rotation(3));  // more than 64 different rest lengths
  return robots;
}

// The mean, summed in double precision.
std::array<double, 3> mean(std::span<const Vec3> values) {
  std::array<double, 3> sum{};
  for (const Vec3 value : values) {
    sum[0] += double{value.x};
    sum[1] += double{value.y};
    sum[2] += double{value.z};
  }
  for (double& component : sum) component /= static_cast<double>(values.size());
  return sum;
}

void expect_means(std::span<const Vec3> means, std::span<const Vec3> values, std::span<const std::size_t> offsets) {
  for (std::size_t i = 0; i < means.size(); ++i) {
    const auto expected = mean(values.subspan(offsets[i], offsets[i + 1] - offsets[i]));
    EXPECT_FLOAT_EQ(means[i].x, static_cast<float>(expected[0])) << i;
    EXPECT_FLOAT_EQ(means[i].y, static_cast<float>(expected[1])) << i;
    EXPECT_FLOAT_EQ(means[i].z, static_cast<float>(expected[2])) << i;
  }
}

void expect_same_state(const State& a, const State& b) {
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.velocities, b.velocities);
  EXPECT_EQ(a.exploded, b.exploded);
}

// The arrays are read first: they have the state before any other function looks at it.
void expect_present_state(SharedBatch& batch) {
  const auto positions = batch.vectors(batch->shared_state(StateArray::positions));
  const auto velocities = batch.vectors(batch->shared_state(StateArray::velocities));
  const auto centers = batch.vectors(batch->shared_state(StateArray::centers));
  const auto center_velocities = batch.vectors(batch->shared_state(StateArray::center_velocities));
  const auto exploded = batch.read(batch->shared_exploded());
  std::vector<Vec3> x(batch->mass_count()), v(batch->mass_count());
  batch->read_positions(x);
  batch->read_velocities(v);
  EXPECT_EQ(positions, x);
  EXPECT_EQ(velocities, v);
  ASSERT_EQ(centers.size(), batch->size());
  ASSERT_EQ(center_velocities.size(), batch->size());
  ASSERT_EQ(exploded.size(), batch->size());
  expect_means(centers, x, batch->mass_offsets());
  expect_means(center_velocities, v, batch->mass_offsets());
  const auto telemetry = batch->telemetry();
  for (std::size_t i = 0; i < exploded.size(); ++i) EXPECT_EQ(exploded[i], telemetry[i].exploded ? 1 : 0) << i;
}

TEST_P(SharedArrays, HaveTheStateAfterEveryStepAndChange) {
  const std::vector<Robot> robots = crowd();
  SharedBatch batch = this->batch({}, robots);
  const auto after = [&](const char* what) {
    SCOPED_TRACE(what);
    expect_present_state(batch);
  };
  after("the start");
  batch->step(20);
  after("step");
  batch->step_in_stream(20, nullptr);
  after("step_in_stream");
  (void)batch->step_and_sample(20, 10);
  after("step_and_sample");
  const State start = bodies::shaken(robots[2], 0.01f, 0.3f, 1);
  batch->set_state(2, start.positions, start.velocities);
  after("set_state");
  State exploded = batch->state(0);
  exploded.exploded = true;
  batch->set_state(0, exploded);
  after("an explosion");
  EXPECT_EQ(batch.read(batch->shared_exploded()), (std::vector<std::uint8_t>{1, 0, 0, 0, 0}));
  batch->step(20);
  after("a step with an exploded robot");
  batch->reset(std::vector<std::uint8_t>{1, 0, 0, 1, 0});
  after("reset of some");
  batch->step_in_stream(20, nullptr);
  batch->reset_in_stream(batch.shared({0, 0, 1, 0, 1}).get(), nullptr);
  after("reset_in_stream");
  Configuration land = batch->configuration();
  land.environment = Land{};
  batch->configure(land);
  after("coming to land");
  batch->step(20);
  batch->reset();
  after("reset");
  batch->add(robots[3]);
  after("add");
  batch->step(20);
  after("a step with an added robot");
  batch->keep(std::array<std::size_t, 4>{5, 2, 0, 4});
  after("keep");
  batch->step_in_stream(20, nullptr);
  after("a step of those that were kept");
}

TEST_P(SharedArrays, StayWhereTheyAre) {
  const std::vector<Robot> robots = crowd();
  SharedBatch batch = this->batch({}, robots);
  const auto before = batch->shared_state(StateArray::positions);
  const auto exploded = batch->shared_exploded();
  EXPECT_EQ(before.rows, batch->mass_count());
  EXPECT_EQ(before.columns, 3u);
  EXPECT_EQ(before.cuda_device, batch->cuda_device());
  EXPECT_EQ(exploded.rows, robots.size());
  EXPECT_EQ(exploded.columns, 1u);
  batch->step(5);
  batch->step_in_stream(5, nullptr);
  batch->reset();
  EXPECT_EQ(batch->shared_state(StateArray::positions).data, before.data);
  EXPECT_EQ(batch->shared_exploded().data, exploded.data);
}

TEST_P(SharedArrays, OfABatchBeforeAddAndKeepStayAsTheyWere) {
  const std::vector<Robot> robots = crowd();
  SharedBatch batch = this->batch({}, robots);
  batch->step(10);
  const auto first = batch->shared_state(StateArray::positions);
  const auto then = batch.vectors(first);
  batch->add(robots);
  batch->step(10);
  const auto second = batch->shared_state(StateArray::positions);
  EXPECT_NE(second.data, first.data);
  EXPECT_EQ(second.rows, 2 * first.rows);
  EXPECT_EQ(batch.vectors(first), then);
  const auto later = batch.vectors(second);
  batch->keep(std::array<std::size_t, 2>{3, 8});
  batch->step(10);
  EXPECT_NE(batch->shared_state(StateArray::positions).data, second.data);
  EXPECT_EQ(batch.vectors(second), later);
}

TEST_P(SharedArrays, HoldWhatCopyPositionsWrites) {
  const std::vector<Robot> robots = crowd();
  SharedBatch batch = this->batch({}, robots), other = this->batch({}, robots);
  const auto target = other->shared_state(StateArray::positions);
  if (batch->cuda_device() < 0) {
    EXPECT_THROW(batch->copy_positions(target.data.get()), std::logic_error);
    return;
  }
  batch->step_in_stream(20, reinterpret_cast<void*>(std::uintptr_t{2}));  // cudaStreamPerThread
  batch->copy_positions(target.data.get());
  std::vector<Vec3> x(batch->mass_count());
  batch->read_positions(x);
  EXPECT_EQ(other.vectors(target), x);
}

TEST_P(SharedArrays, StepsLeavePositionsInTheGivenMemory) {
  const std::vector<Robot> robots = crowd();
  SharedBatch batch = this->batch({}, robots), other = this->batch({}, robots);
  const auto target = other->shared_state(StateArray::positions);
  if (batch->cuda_device() < 0) {
    EXPECT_THROW(batch->copy_positions_with_steps(target.data), std::logic_error);
    return;
  }
  const auto present = [&] {
    std::vector<Vec3> x(batch->mass_count());
    batch->read_positions(x);
    return x;
  };
  batch->copy_positions_with_steps(target.data);
  EXPECT_TRUE(batch->copy_positions(target.data.get())) << "nothing has stepped yet";
  batch->step(20);
  EXPECT_EQ(other.vectors(target), present());
  EXPECT_FALSE(batch->copy_positions(target.data.get())) << "they are there";
  batch->set_state(2, {.positions = robots[2].masses, .velocities = std::vector<Vec3>(robots[2].masses.size())});
  EXPECT_TRUE(batch->copy_positions(target.data.get())) << "a robot has moved since";
  EXPECT_EQ(other.vectors(target), present());
  batch->step_and_sample(10, 5);
  EXPECT_EQ(other.vectors(target), present());
  batch->keep(std::array<std::size_t, 2>{1, 3});
  const auto before = other.vectors(target);
  batch->step(10);
  EXPECT_EQ(other.vectors(target), before) << "it ends when robots go";
}

TEST_P(SharedArrays, OutliveTheirSimulation) {
  const std::vector<Robot> robots = crowd();
  SharedArray<float> positions;
  std::vector<Vec3> last(0);
  {
    SharedBatch batch = this->batch({}, robots);
    positions = batch->shared_state(StateArray::positions);
    batch->step_in_stream(10, nullptr);
    last = batch.vectors(positions);
  }
  EXPECT_EQ(this->batch({}, {}).vectors(positions), last);
}

TEST_P(SharedArrays, OfAnEmptyBatchAreEmptyAndGrow) {
  SharedBatch batch = this->batch({}, {});
  EXPECT_EQ(batch->shared_state(StateArray::centers).rows, 0u);
  EXPECT_EQ(batch->shared_exploded().rows, 0u);
  EXPECT_EQ(batch->actuation().drive.rows, 0u);
  batch->step_in_stream(5, nullptr);
  batch->reset_in_stream(nullptr, nullptr);
  const std::vector<Robot> robots = crowd();
  batch->add(robots);
  batch->step(5);
  expect_present_state(batch);
}

TEST_P(SharedArrays, AreNotRead) {
  const std::vector<Robot> robots = crowd();
  SharedBatch batch = this->batch({}, robots), untouched = this->batch({}, robots);
  const auto positions = batch->shared_state(StateArray::positions);
  batch.write(positions, std::vector<float>(positions.rows * 3, 1e9f));
  batch.write(batch->shared_exploded(), std::vector<std::uint8_t>(robots.size(), 1));
  batch->step(20);
  untouched->step(20);
  EXPECT_EQ(batch->hashes(), untouched->hashes());
  expect_present_state(batch);
}

TEST_P(SharedArrays, CentersDependOnTheRobotAlone) {
  const std::vector<Robot> robots = crowd();
  SharedBatch batch = this->batch({}, robots), alone = this->batch({}, std::span(robots).subspan(2, 1));
  batch->step(30);
  alone->step(30);
  for (const StateArray which : {StateArray::centers, StateArray::center_velocities})
    EXPECT_EQ(batch.vectors(batch->shared_state(which))[2], alone.vectors(alone->shared_state(which))[0]);
}

class ResetOfSome : public test::SharedBatchTest {};
INSTANTIATE_TEST_SUITE_P(All, ResetOfSome, test::every_backend, test::SharedBatchTest::name);

// The same with a mask on the host and with one in shared memory.
TEST_P(ResetOfSome, PutsThemAtRestAndLetsTheOthersGoOn) {
  const std::vector<Robot> robots = crowd();
  const std::vector<std::uint8_t> mask = {1, 0, 1, 0, 7};
  for (const bool in_stream : {false, true})
    for (const Environment& environment : {Environment(Ocean{}), Environment(Land{})}) {
      SharedBatch batch = this->batch({.environment = environment}, robots);
      SharedBatch others = this->batch({.environment = environment}, robots);
      std::vector<State> rest;
      for (std::size_t i = 0; i < robots.size(); ++i) rest.push_back(batch->state(i));
      batch->step(50);
      others->step(50);
      State far = batch->state(0);
      far.exploded = true;
      batch->set_state(0, far);
      const auto reset = [&] {
        if (in_stream)
          batch->reset_in_stream(batch.shared(mask).get(), nullptr);
        else
          batch->reset(mask);
      };
      reset();
      for (const std::size_t i : {0u, 2u, 4u}) expect_same_state(batch->state(i), rest[i]);
      EXPECT_EQ(batch->steps(), 50);
      batch->step(50);
      others->step(50);
      for (const std::size_t i : {1u, 3u}) EXPECT_EQ(batch->hash(i), others->hash(i)) << i;
      EXPECT_FALSE(batch->telemetry(0).exploded);
      EXPECT_NE(batch->state(0).positions, rest[0].positions) << "it moves again";
    }
}

TEST_P(ResetOfSome, WithoutMusclesIsANewStart) {
  std::vector<Robot> robots;
  for (int i = 0; i < 3; ++i) robots.push_back(bodies::voxels({.x = 2, .y = 2, .z = 2 + i}, {60, 0, 0, 0}));
  const Configuration land{.environment = Land{}};
  SharedBatch batch = this->batch(land, robots), fresh = this->batch(land, robots);
  for (std::size_t i = 0; i < 3; ++i) {
    const State thrown = bodies::moving(robots[i], {0.3f, 0.1f, 1});
    batch->set_state(i, thrown.positions, thrown.velocities);
  }
  batch->step(40);
  batch->reset(std::vector<std::uint8_t>{0, 1, 1});
  batch->step(60);
  fresh->step(60);
  EXPECT_NE(batch->hash(0), fresh->hash(0));
  EXPECT_EQ(batch->hash(1), fresh->hash(1));
  EXPECT_EQ(batch->hash(2), fresh->hash(2));
}

TEST_P(ResetOfSome, NeedsOneElementPerRobot) {
  SharedBatch batch = this->batch({}, crowd());
  EXPECT_THROW(batch->reset(std::vector<std::uint8_t>(4)), std::invalid_argument);
}

}  // namespace
}  // namespace mercury
