// SPDX-License-Identifier: Apache-2.0
// Verdicts on results: by their definition, and on robots whose behavior is known.
#include "mercury/confirmation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "mercury/error.h"
#include "mercury/robot_file.h"
#include "mercury/voxel.h"
#include "tests/sim/backend.h"

namespace mercury {
namespace {

using testing::HasSubstr;

CheckedStep step(double dt, double median, double between, double steady = 1, Fate fate = Fate::sound) {
  return {.dt = dt,
          .fate = fate,
          .score = {.lower_quartile = median - between / 2, .median = median, .upper_quartile = median + between / 2},
          .steady_share = steady};
}

Confirmation judged(CheckedStep a, CheckedStep b, CheckedStep c, double same = 0, bool travels = true) {
  Confirmation checked{.steps = {a, b, c}};
  judge(checked, same, travels);
  return checked;
}

TEST(Verdict, IsConfirmedIfMediansAgreeAndQuartilesAreNear) {
  const Confirmation checked = judged(step(4e-3, 2, 0.3), step(2e-3, 2.1, 0.3), step(1e-3, 2.15, 0.3));
  EXPECT_EQ(checked.verdict, Verdict::confirmed);
  EXPECT_EQ(checked.reason, "");
}

TEST(Verdict, IsChaoticIfTheQuartilesOfAnyStepAreAFifthOfTheMedianApart) {
  EXPECT_EQ(judged(step(4e-3, 2, 0.39), step(2e-3, 2, 0.39), step(1e-3, 2, 0.39)).verdict, Verdict::confirmed);
  EXPECT_EQ(judged(step(4e-3, 2, 0.41), step(2e-3, 2, 0), step(1e-3, 2, 0)).verdict, Verdict::chaotic);
  const Confirmation last = judged(step(4e-3, 2, 0), step(2e-3, 2, 0), step(1e-3, -2, 0.5));
  EXPECT_EQ(last.verdict, Verdict::chaotic);
  EXPECT_EQ(last.reason, "the quartiles at dt 0.001 s, -2.2500 and -1.7500, are 25 % of the median apart");
}

TEST(Verdict, OfMeansOfDifferentTrialsIsNotChaotic) {
  Confirmation checked{.steps = {step(4e-3, 0.6, 0.4), step(2e-3, 0.7, 0.4), step(1e-3, 0.9, 0.4)}};
  judge(checked, 0, false, true);
  EXPECT_EQ(checked.verdict, Verdict::confirmed);
  checked = {.steps = {step(4e-3, 0.6, 0.2), step(2e-3, 0.7, 0.2), step(1e-3, 0.9, 0.2)}};
  judge(checked, 0, false, true);
  EXPECT_EQ(checked.verdict, Verdict::depends_on_dt);
  EXPECT_EQ(checked.reason, "the mean is 0.6000 at dt 0.004 s and 0.9000 at dt 0.001 s");
}

TEST(Verdict, DependsOnDtIfTheMedianAtAQuarterIsAnotherOne) {
  EXPECT_EQ(judged(step(4e-3, 2.19, 0), step(2e-3, 9, 0), step(1e-3, 2, 0)).verdict, Verdict::confirmed);
  const Confirmation other = judged(step(4e-3, 2.21, 0), step(2e-3, 2, 0), step(1e-3, 2, 0));
  EXPECT_EQ(other.verdict, Verdict::depends_on_dt);
  EXPECT_EQ(other.reason, "the median is 2.2100 at dt 0.004 s and 2.0000 at dt 0.001 s");
  // Not beyond the spread.
  EXPECT_EQ(judged(step(4e-3, 2.21, 0.3), step(2e-3, 2, 0), step(1e-3, 2, 0)).verdict, Verdict::confirmed);
  // Sound only at the coarse step.
  const Confirmation torn = judged(step(4e-3, 2, 0), step(2e-3, 2, 0), step(1e-3, 2, 0, 1, Fate::overstretched));
  EXPECT_EQ(torn.verdict, Verdict::depends_on_dt);
  EXPECT_EQ(torn.reason, "overstretched at dt 0.001 s");
}

TEST(Verdict, IsTransientIfMostTrialsAreNotSteady) {
  const auto of = [](double steady, bool travels) {
    return judged(step(4e-3, 2, 0, steady), step(2e-3, 2, 0), step(1e-3, 2, 0), 0, travels).verdict;
  };
  EXPECT_EQ(of(0.6, true), Verdict::confirmed);
  EXPECT_EQ(of(0.4, true), Verdict::transient);
  EXPECT_EQ(of(0.4, false), Verdict::confirmed);  // a height need not last
}

TEST(Verdict, RobotsThatAreNotSoundAreNotConfirmed) {
  EXPECT_EQ(judged(step(4e-3, 2, 0, 1, Fate::exploded), step(2e-3, 2, 0), step(1e-3, 2, 0)).verdict, Verdict::unsound);
  EXPECT_EQ(judged(step(4e-3, 2, 0, 1, Fate::failed), step(2e-3, 2, 0), step(1e-3, 2, 0)).verdict, Verdict::failed);
}

TEST(Verdict, ScoresThatDifferByNextToNothingAreTheSame) {
  EXPECT_EQ(judged(step(4e-3, 1e-4, 1e-4), step(2e-3, 0, 0), step(1e-3, -1e-4, 0), 1e-3).verdict, Verdict::confirmed);
  EXPECT_EQ(judged(step(4e-3, 1e-4, 1e-4), step(2e-3, 0, 0), step(1e-3, -1e-4, 0), 1e-5).verdict, Verdict::chaotic);
}

TEST(Verdict, NamesReadBack) {
  for (const Verdict verdict : {Verdict::failed, Verdict::unsound, Verdict::chaotic, Verdict::depends_on_dt,
                                Verdict::transient, Verdict::confirmed})
    EXPECT_EQ(verdict_named(name_of(verdict)), verdict);
  EXPECT_EQ(verdict_named("splendid"), std::nullopt);
}

class CheckOn : public BackendTest {
 protected:
  Confirmation checked(const Robot& robot, const Environment& world, double seconds, double dt = 1e-3) {
    TrialSettings trials = check_settings();
    trials.seconds = seconds;
    const RobotSource robots = [robot = std::make_shared<const Robot>(robot)](std::size_t) { return robot; };
    return check_robots(robots, 1, {.dt = dt, .environment = world, .device = device()}, trials, Objective("distance"),
                        1, {})
        .value()
        .front();
  }
};
INSTANTIATE_TEST_SUITE_P(All, CheckOn, every_device, BackendTest::name);

// A cube that is thrown in empty space moves evenly.
TEST_P(CheckOn, AThrownCubeIsConfirmed) {
  Robot cube = make_voxel_robot(VoxelGrid(2, 2, 2, tissue));
  cube.velocity.assign(cube.masses.size(), {0.5f, 0, 0});
  const Confirmation found = checked(cube, environment_named("space"), 1);
  // Damping of 0.1/s: 0.5 (1 - exp(-0.1)) / 0.1 m.
  for (const CheckedStep& one : found.steps) EXPECT_NEAR(one.score.median, 5 * (1 - std::exp(-0.1)), 1e-3);
  EXPECT_EQ(found.verdict, Verdict::confirmed) << found.reason;
}

// The same in water soon stands still.
TEST_P(CheckOn, ACubeThatWaterStopsIsTransient) {
  Robot cube = make_voxel_robot(VoxelGrid(2, 2, 2, tissue));
  cube.velocity.assign(cube.masses.size(), {2, 0, 0});
  EXPECT_EQ(checked(cube, Ocean{}, 3).verdict, Verdict::transient);
}

// A time step beyond what the springs take (2 over their highest angular frequency) is not confirmed.
TEST_P(CheckOn, AnUnstableTimeStepIsNotConfirmed) {
  const Robot cube = make_voxel_robot(VoxelGrid(3, 3, 3, 1));
  EXPECT_THAT(std::string(name_of(checked(cube, Land{}, 1, 0.02).verdict)),
              testing::AnyOf("not sound", "depends on dt", "chaotic"));
}

TEST_P(CheckOn, VerdictsDoNotDependOnOtherRobots) {
  std::vector<std::shared_ptr<const Robot>> robots;
  for (int x = 1; x < 5; ++x)
    robots.push_back(std::make_shared<const Robot>(make_voxel_robot(VoxelGrid(x, 2, 2, static_cast<MaterialId>(x)))));
  TrialSettings trials = check_settings();
  trials.seconds = 1;
  const Configuration configuration{.environment = Land{}, .device = device()};
  const auto all = check_robots(source_of(robots), 4, configuration, trials, Objective("distance"), 3, {}).value();
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_EQ(check_robots(source_of({robots[i]}), 1, configuration, trials, Objective("distance"), 3, {}).value(),
              std::vector{all[i]});
}

TEST(Check, RobotsThatCannotBeMadeHaveFailed) {
  const RobotSource robots = [](std::size_t) -> std::shared_ptr<const Robot> { throw InputError("robot", "is none"); };
  TrialSettings trials = check_settings();
  trials.seconds = 0.1;
  const auto checked =
      check_robots(robots, 1, {.device = {.kind = DeviceKind::cpu}}, trials, Objective("distance"), 1, {});
  EXPECT_EQ(checked.value().front().verdict, Verdict::failed);
  EXPECT_EQ(checked->front().reason, "robot: is none");
}

TEST(Check, StopsIfTheWatchSaysSo) {
  TrialSettings trials = check_settings();
  const RobotSource robots = source_of({std::make_shared<const Robot>(make_voxel_robot(VoxelGrid(2, 2, 2, 1)))});
  EXPECT_EQ(check_robots(robots, 1, {.device = {.kind = DeviceKind::cpu}}, trials, Objective("distance"), 1,
                         [](std::size_t, std::size_t) { return false; }),
            std::nullopt);
}

}  // namespace
}  // namespace mercury
