// SPDX-License-Identifier: Apache-2.0
// Pace, time series, ranking and CSV tables.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "app/live/measurements.h"
#include "app/live/stepping.h"
#include "mercury/random_voxel.h"
#include "tests/app/live/live_scene_setup.h"

namespace mercury {
namespace {

TEST(Pace, DueStepsAreWallTimeTimesSpeedOverTimeStep) {
  Pace pace;
  pace.start(100, 2, 1e-3);
  EXPECT_EQ(pace.due(100), 0);
  EXPECT_EQ(pace.due(100.01), 20);
  pace.done(20);
  EXPECT_EQ(pace.due(100.01), 0);
  EXPECT_NEAR(pace.next_due(), 100.0105, 1e-9);
  EXPECT_EQ(pace.due(100.0106), 1);
}

TEST(Pace, SlowMotionWaitsForWholeSteps) {
  Pace pace;
  pace.start(0, 1e-3, 1e-3);  // one step per second
  EXPECT_EQ(pace.due(0.9), 0);
  EXPECT_EQ(pace.due(1.0), 1);
  pace.done(1);
  EXPECT_NEAR(pace.next_due(), 2, 1e-9);
  EXPECT_EQ(pace.due(1.99), 0);
  EXPECT_EQ(pace.due(2.01), 1);
}

TEST(Pace, LateStepsAreForgotten) {
  Pace pace;
  pace.start(0, 1, 1e-3);
  // Physics that needs 50 ms for 10 steps falls behind; never more than a tenth of a second is due.
  for (double wall = 0; wall < 20; wall += 0.05) {
    EXPECT_LE(pace.due(wall), 101);
    pace.done(10);
  }
  // After an hour of sleep.
  EXPECT_LE(pace.due(3600), 101);
  pace.start(0, unlimited_speed, 1e-3);
  EXPECT_EQ(pace.due(1), std::numeric_limits<std::int64_t>::max());
}

TEST(SpeedGauge, IsSimulatedTimeOverWallTimeOfTheLastSecond) {
  SpeedGauge gauge;
  EXPECT_EQ(gauge.speed(), 0);
  for (int i = 0; i <= 100; ++i) gauge.mark(0.1 * i, 0.05 * i);
  EXPECT_NEAR(gauge.speed(), 0.5, 1e-9);
  for (int i = 1; i <= 20; ++i) gauge.mark(10 + 0.1 * i, 5 + 0.2 * i);
  EXPECT_NEAR(gauge.speed(), 2, 0.2);
}

LiveRobots two_robots() {
  LiveRobots robots{.mass_offsets = {0, 1, 2}};
  for (const RobotId id : {RobotId{4}, RobotId{9}})
    robots.robots.push_back({.id = id, .robot = std::make_shared<const Robot>(Robot{.masses = {{0, 0, 0}}})});
  return robots;
}

// Robot k moves along x at k + 1 m/s.
std::vector<Telemetry> moving(double time) {
  std::vector<Telemetry> telemetry(2);
  for (int k = 0; k < 2; ++k) {
    telemetry[static_cast<std::size_t>(k)].center_of_mass = {static_cast<float>((k + 1) * time), 0, 0};
    telemetry[static_cast<std::size_t>(k)].velocity = {static_cast<float>(k + 1), 0, 0};
  }
  return telemetry;
}

std::vector<Telemetry> first_of(const std::vector<Telemetry>& telemetry) { return {telemetry.front()}; }

TEST(Measurements, SamplesOfLongRunsAreFewAndEvenlySpaced) {
  Measurements measurements(16);
  measurements.restart(two_robots(), 0, 0, {}, moving(0));
  for (std::int64_t step = 0; step <= 100'000; step = measurements.next_step())
    measurements.observe(1e-3 * static_cast<double>(step), step, moving(1e-3 * static_cast<double>(step)));
  const Series series = measurements.series(9);
  ASSERT_EQ(series.times.size(), series.samples.size());
  EXPECT_LE(series.times.size(), 16u);
  EXPECT_GE(series.times.size(), 7u);
  EXPECT_EQ(series.times.front(), 0);
  for (std::size_t i = 0; i < series.times.size(); ++i) {
    EXPECT_NEAR(series.times[i], static_cast<double>(i) * series.times[1], 1e-9);
    EXPECT_NEAR(series.samples[i].distance, 2 * series.times[i], 1e-4);
    EXPECT_EQ(series.samples[i].speed, 2);
  }
  EXPECT_GT(series.times.back(), 90);
}

TEST(Measurements, RobotAddedLaterHasItsOwnStartAndSamples) {
  for (const std::int64_t added_at : {60, 80, 100, 120}) {
    Measurements measurements(8);
    const LiveRobots both = two_robots();
    const LiveRobots first{.robots = {both.robots[0]}, .mass_offsets = {0, 1}};
    measurements.restart(first, 0, 0, {}, first_of(moving(0)));
    std::int64_t step = 0;
    const auto time = [&] { return 1e-3 * static_cast<double>(step); };
    for (; step < added_at; step = measurements.next_step())
      measurements.observe(time(), step, first_of(moving(time())));
    const double came = time();
    measurements.set_robots(both, came, Ocean{}, moving(came));
    for (; step < 3000; step = measurements.next_step()) measurements.observe(time(), step, moving(time()));
    const Series series = measurements.series(9);
    ASSERT_EQ(series.times.size(), series.samples.size());
    ASSERT_FALSE(series.times.empty());
    EXPECT_GE(series.times.front(), came);
    for (std::size_t i = 0; i < series.times.size(); ++i)
      EXPECT_NEAR(series.samples[i].distance, 2 * (series.times[i] - came), 1e-4) << added_at;
    EXPECT_NEAR(measurements.series(4).samples.back().distance, measurements.series(4).times.back(), 1e-4);
    EXPECT_TRUE(measurements.series(5).times.empty());
  }
}

TEST(Measurements, DistancesOnLandAreAlongTheGround) {
  for (const bool on_land : {false, true}) {
    Measurements measurements;
    Configuration configuration;
    if (on_land) configuration.environment = Land{};
    std::vector<Telemetry> telemetry(2);
    measurements.restart(two_robots(), 0, 0, configuration, telemetry);
    telemetry[0].center_of_mass = {3, 4, -12};  // 5 along the ground, 13 through space
    measurements.observe(1, 1000, telemetry);
    EXPECT_DOUBLE_EQ(measurements.ranking()[0].distance, on_land ? 5 : 13);
  }
}

// Robot 9 starts 1 s after robot 4; both move steadily.
TEST(Measurements, DistancesAtEqualAgeAreThoseAtTheAgeOfTheYoungest) {
  Measurements measurements(64);
  const LiveRobots both = two_robots();
  const LiveRobots first{.robots = {both.robots[0]}, .mass_offsets = {0, 1}};
  measurements.restart(first, 0, 0, {}, first_of(moving(0)));
  std::int64_t step = 0;
  const auto time = [&] { return 1e-3 * static_cast<double>(step); };
  for (; step < 1000; step = measurements.next_step()) measurements.observe(time(), step, first_of(moving(time())));
  const double came = time();
  measurements.set_robots(both, came, Ocean{}, moving(came));
  for (; step < 2500; step = measurements.next_step()) measurements.observe(time(), step, moving(time()));
  measurements.observe(2.51, 2510, moving(2.51));
  const auto rows = measurements.ranking();
  EXPECT_NEAR(rows[0].age, 2.51, 1e-9);
  EXPECT_NEAR(rows[1].age, 2.51 - came, 1e-9);
  EXPECT_NEAR(rows[0].distance, 2.51, 1e-5);
  EXPECT_NEAR(rows[0].distance_at_equal_age, rows[1].age, 1e-5);
  EXPECT_NEAR(rows[1].distance_at_equal_age, rows[1].distance, 1e-9);
  EXPECT_NEAR(rows[1].distance, 2 * rows[1].age, 1e-5);
}

// Whatever the figure and the direction of the order.
TEST(Measurements, ExplodedRobotsRankLast) {
  const RankingRow slow{.distance = 1}, fast{.distance = 2}, exploded{.distance = 8.1, .exploded = true};
  for (const bool ascending : {false, true}) {
    std::vector<RankingRow> rows{exploded, slow, exploded, fast};
    std::ranges::stable_sort(
        rows, [&](const auto& a, const auto& b) { return ranks_before(a, b, a.distance, b.distance, ascending); });
    EXPECT_EQ(rows[0].distance, ascending ? 1 : 2);
    EXPECT_EQ(rows[1].distance, ascending ? 2 : 1);
    EXPECT_TRUE(rows[2].exploded && rows[3].exploded);
  }
}

TEST(LiveMeasures, RankingAndTablesHoldTheValuesOfTheSimulation) {
  test::RobotScene scene(3);
  test::step_and_wait(scene, 500);
  const auto rows = scene.measurements().ranking();
  ASSERT_EQ(rows.size(), 3u);
  Simulation simulation(test::on_cpu().configuration, random_voxel_robots({}, 5, 3));
  const auto start = simulation.telemetry();
  simulation.step(500);
  const auto end = simulation.telemetry();
  for (std::size_t i = 0; i < 3; ++i) {
    const double distance = length(end[i].center_of_mass - start[i].center_of_mass);
    EXPECT_NEAR(rows[i].distance, distance, 1e-6);
    EXPECT_NEAR(rows[i].mean_speed, distance / 0.5, 1e-5);
    EXPECT_NEAR(rows[i].kinetic_energy, end[i].kinetic_energy, 1e-9);
    EXPECT_GE(rows[i].largest_strain, end[i].largest_strain);
  }
  // The last line is that of step 500, because the first interval is 20 ms.
  std::istringstream csv(series_csv(scene.document(), scene.measurements(), test::ids_of(scene)));
  std::string line, header, last;
  std::getline(csv, header);
  EXPECT_TRUE(header.starts_with("time [s],voxel-5-0 speed [m/s],voxel-5-0 distance [m],")) << header;
  int lines = 0;
  while (std::getline(csv, line)) {
    ++lines;
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), std::count(header.begin(), header.end(), ','));
    last = line;
  }
  EXPECT_EQ(lines, 26);
  std::istringstream fields(last);
  double time = 0, speed = 0, distance = 0;
  char comma = 0;
  fields >> time >> comma >> speed >> comma >> distance;
  EXPECT_NEAR(time, 0.5, 1e-9);
  EXPECT_NEAR(speed, length(end[0].velocity), 1e-6);
  EXPECT_NEAR(distance, rows[0].distance, 1e-6);
  // The farthest robot comes first.
  std::istringstream ranking(ranking_csv(scene.document(), scene.measurements()));
  std::getline(ranking, header);
  double before = INFINITY;
  for (std::string name; std::getline(ranking, name, ','); std::getline(ranking, line)) {
    ranking >> distance;
    EXPECT_LE(distance, before);
    before = distance;
  }
}

}  // namespace
}  // namespace mercury
