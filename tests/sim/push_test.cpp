// SPDX-License-Identifier: Apache-2.0
// The environment's push: a velocity that all masses get at once.
#include <gtest/gtest.h>

#include <array>

#include "bodies.h"
#include "shared_batch.h"

namespace mercury {
namespace {

using test::SharedBatch;

class PushOn : public test::SharedBatchTest {};
INSTANTIATE_TEST_SUITE_P(All, PushOn, test::every_backend, test::SharedBatchTest::name);

constexpr Vec3 push{0.3f, -0.2f, 0.1f};

// Empty space without damping: nothing else changes the momentum.
Configuration pushed_at(float seconds) {
  Environment environment = empty_space();
  environment.push = push;
  environment.push_at = seconds;
  return {.dt = 1e-3, .damping = 0, .environment = environment};
}

Robot moving_bar() { return bodies::voxels({.x = 4, .y = 1, .z = 1}, {50, 0.2f, 5, 0}); }

TEST_P(PushOn, AddsItsVelocityToTheCenterOfMassOnceAtItsTime) {
  const std::array robots{moving_bar(), bodies::voxels({.x = 2, .y = 2, .z = 2}, {50, 0, 0, 0})};
  SharedBatch batch = this->batch(pushed_at(0.05f), robots);
  batch->step(50);
  for (const Telemetry& telemetry : batch->telemetry()) EXPECT_LT(length(telemetry.velocity), 1e-5f);
  batch->step(1);
  for (const Telemetry& telemetry : batch->telemetry()) EXPECT_LT(length(telemetry.velocity - push), 1e-5f);
  const std::vector<Telemetry> before = batch->telemetry();
  batch->step(1000);
  for (std::size_t i = 0; i < robots.size(); ++i) {
    const Telemetry after = batch->telemetry(i);
    EXPECT_LT(length(after.velocity - push), 1e-4f);
    EXPECT_LT(length(after.center_of_mass - before[i].center_of_mass - push), 1e-3f);  // after a second
  }
}

TEST_P(PushOn, IsTheSameHoweverStepsAreDividedAndSampled) {
  const std::array robots{moving_bar(), moving_bar()};
  SharedBatch at_once = this->batch(pushed_at(0.123f), robots);
  at_once->step(300);
  SharedBatch divided = this->batch(pushed_at(0.123f), robots);
  for (const std::int64_t steps : {100, 23, 1, 76, 100}) divided->step(steps);
  EXPECT_EQ(divided->hashes(), at_once->hashes());
  SharedBatch sampled = this->batch(pushed_at(0.123f), robots);
  const std::vector<Telemetry> samples = sampled->step_and_sample(300, 50);
  EXPECT_EQ(sampled->hashes(), at_once->hashes());
  EXPECT_LT(length(samples[2 * 1].velocity), 1e-5f);  // after 100 steps
  EXPECT_LT(length(samples[2 * 2].velocity - push), 1e-4f);
  SharedBatch alone = this->batch(pushed_at(0.123f), std::span(robots).first(1));
  alone->step_in_stream(300, nullptr);
  EXPECT_EQ(alone->hash(0), at_once->hash(0));
}

TEST_P(PushOn, GoesOnBitForBitFromAStateThatWasSavedAtItsTime) {
  const std::array robots{moving_bar()};
  SharedBatch batch = this->batch(pushed_at(0.1f), robots);
  batch->step(100);
  const BatchState saved = batch->save();
  batch->step(100);
  const std::uint64_t hash = batch->hash(0);
  EXPECT_GT(length(batch->telemetry(0).velocity), 0.3f);
  batch->restore(saved);
  batch->step(100);
  EXPECT_EQ(batch->hash(0), hash);
}

TEST_P(PushOn, LeavesFixedMassesAndExplodedRobotsAlone) {
  std::array robots{moving_bar(), moving_bar()};
  robots[0].fixed = {0};
  SharedBatch batch = this->batch(pushed_at(0.01f), robots);
  State exploded = batch->state(1);
  exploded.exploded = true;
  batch->set_state(1, exploded);
  batch->step(30);
  EXPECT_EQ(batch->positions(0)[0], robots[0].masses[0]);
  EXPECT_NE(batch->positions(0)[1], robots[0].masses[1]);
  EXPECT_EQ(batch->positions(1), robots[1].masses);
  EXPECT_TRUE(batch->telemetry(1).exploded);
}

// The nearest step to its time, whatever the time step; none for a time that is over.
TEST_P(PushOn, ComesAtTheSameTimeWithAnotherTimeStep) {
  const std::array robots{moving_bar()};
  Configuration configuration = pushed_at(0.05f);
  SharedBatch batch = this->batch(configuration, robots);
  batch->step(30);
  configuration.dt = 5e-4;
  batch->configure(configuration);
  batch->step(40);
  EXPECT_LT(length(batch->telemetry(0).velocity), 1e-5f);
  batch->step(1);
  EXPECT_LT(length(batch->telemetry(0).velocity - push), 1e-5f);
  configuration.environment.push_at = 0.01f;
  batch->configure(configuration);
  batch->step(100);
  EXPECT_LT(length(batch->telemetry(0).velocity - push), 1e-4f);
}

}  // namespace
}  // namespace mercury
