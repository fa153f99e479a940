// SPDX-License-Identifier: Apache-2.0
// In slow motion the picture moves evenly between the states of two steps.
#include <gtest/gtest.h>

#include <cmath>

#include "app/live/drawn_scene.h"

namespace mercury {
namespace {

// One mass that moves at 2 m/s, after `steps` steps; due at the wall time of its step.
std::shared_ptr<const Snapshot> snapshot_at(std::int64_t steps, double speed, bool playing = true,
                                            std::uint64_t resets = 0) {
  static const auto robots = std::make_shared<const LiveRobots>(LiveRobots{.revision = 1, .mass_offsets = {0, 1}});
  auto snapshot = std::make_shared<Snapshot>();
  snapshot->robots = robots;
  snapshot->steps = steps;
  snapshot->resets = resets;
  snapshot->time = static_cast<double>(steps) * snapshot->configuration.dt;
  const Vec3 place{static_cast<float>(2 * snapshot->time), 0, 1};
  snapshot->positions.set_on_host(1)[0] = place;
  snapshot->telemetry = {{.center_of_mass = place}};
  snapshot->playing = playing;
  snapshot->speed = speed;
  snapshot->due_at = snapshot->time / speed;
  return snapshot;
}

TEST(SlowMotion, MovesEvenlyAtAnyRateOfSteps) {
  // Steps per second: one, somewhat fewer than pictures, somewhat more, many more.
  for (const double speed : {0.001, 0.05, 0.07, 0.2}) {
    SlowMotion motion;
    const double picture = 1 / 60.0, period = 0.001 / speed;
    motion.take(snapshot_at(0, speed));
    double last = 0;
    std::int64_t published = 0;
    int pictures = 0;
    for (double wall = 0; wall < std::max(1.0, 12 * period); wall += picture) {
      // The physics thread publishes the newest step one picture late.
      const auto steps = static_cast<std::int64_t>(std::floor(std::max(0.0, wall - picture) / period + 1e-9));
      if (steps > published) motion.take(snapshot_at(published = steps, speed));
      const SlowMotion::Shown shown = motion.at(wall);
      const double expected = std::max(0.0, (wall - period - SlowMotion::allowance) * speed);
      EXPECT_NEAR(shown.time, expected, 1e-9) << speed << " at " << wall;
      EXPECT_NEAR(shown.positions[0].x, 2 * shown.time, 1e-6);
      EXPECT_EQ(shown.positions[0].z, 1);
      EXPECT_NEAR(shown.telemetry[0].center_of_mass.x, 2 * shown.time, 1e-6);
      EXPECT_LE(shown.time, static_cast<double>(published) * 0.001 + 1e-12) << "only computed states are shown";
      pictures += shown.time > last;
      last = shown.time;
    }
    EXPECT_GT(pictures, 30) << "almost every picture differs from the previous one, at " << speed;
  }
}

TEST(SlowMotion, ShowsTheNewestStateWhenPausedOrFast) {
  SlowMotion motion;
  motion.take(snapshot_at(3, 0.001));
  motion.take(snapshot_at(4, 0.001));
  EXPECT_LT(motion.at(4.0).time, 0.004);
  motion.take(snapshot_at(4, 0.001, false));  // paused
  EXPECT_EQ(motion.at(4.1).time, 0.004);
  EXPECT_EQ(motion.at(4.1).positions[0].x, 0.008f);
  motion.take(snapshot_at(900, 1));
  motion.take(snapshot_at(916, 1));
  EXPECT_EQ(motion.at(0.917).time, 0.916) << "a thousand steps per second need no interpolation";
}

TEST(SlowMotion, TimeNeverGoesBackExceptAtAReset) {
  SlowMotion motion;
  motion.take(snapshot_at(10, 0.001));
  motion.take(snapshot_at(11, 0.001));
  const double before = motion.at(12.0).time;
  EXPECT_GT(before, 0.0105);
  // At a higher speed the picture lags further behind.
  motion.take(snapshot_at(12, 0.2));
  EXPECT_GE(motion.at(snapshot_at(12, 0.2)->due_at).time, before);
  motion.take(snapshot_at(0, 0.2, true, 1));
  EXPECT_EQ(motion.at(100).time, 0);
}

}  // namespace
}  // namespace mercury
