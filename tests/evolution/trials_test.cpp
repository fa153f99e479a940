// SPDX-License-Identifier: Apache-2.0
// Trials with jitter: what each begins with, and what they give together.
#include "mercury/trials.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <memory>

#include "mercury/assessor.h"
#include "mercury/error.h"
#include "mercury/genome.h"
#include "mercury/quantity.h"
#include "mercury/random_voxel.h"
#include "mercury/robot_file.h"
#include "mercury/samples.h"
#include "mercury/spread.h"
#include "mercury/voxel.h"
#include "tests/sim/backend.h"

namespace mercury {
namespace {

std::vector<Vec3> displacements(const Robot& robot, const TrialSettings& settings, std::uint64_t seed,
                                std::size_t trial) {
  std::vector<Vec3> positions(robot.masses.size());  // from the origin, so that nothing is rounded
  add_jitter(robot, settings, seed, trial, positions);
  return positions;
}

TEST(Jitter, IsNormalWithItsStandardDeviationPerShortestRestLength) {
  Robot block = make_voxel_robot(VoxelGrid(14, 14, 14, tissue));
  block.springs[7].rest_length = 0.05f;
  const double deviation = 1e-3 * 0.05;
  double sum = 0, squares = 0, fourth = 0, count = 0;
  for (const Vec3& d : displacements(block, {.jitter = 1e-3}, 1, 0))
    for (const double x : {d.x / deviation, d.y / deviation, d.z / deviation})
      sum += x, squares += x * x, fourth += x * x * x * x, ++count;
  // Five standard errors of the first moments of a normal distribution.
  EXPECT_NEAR(sum / count, 0, 5 / std::sqrt(count));
  EXPECT_NEAR(squares / count, 1, 5 * std::sqrt(2 / count));
  EXPECT_NEAR(fourth / count, 3, 5 * std::sqrt(96 / count));
}

TEST(Jitter, DependsOnSeedAndTrialAndIsTheSameForAllRobots) {
  const Robot robot = random_voxel_robot({}, 1), larger = make_voxel_robot(VoxelGrid(9, 9, 9, tissue));
  const TrialSettings settings{.trials = 3, .jitter = 1e-3};
  const std::vector<Vec3> first = displacements(robot, settings, 1, 0);
  EXPECT_EQ(first, displacements(robot, settings, 1, 0));
  EXPECT_NE(first, displacements(robot, settings, 1, 1));
  EXPECT_NE(first, displacements(robot, settings, 2, 0));
  // Both have springs of the same shortest rest length, so mass i moves alike in both.
  const std::vector<Vec3> of_larger = displacements(larger, settings, 1, 0);
  ASSERT_GT(of_larger.size(), first.size());
  EXPECT_TRUE(std::equal(first.begin(), first.end(), of_larger.begin()));
}

TEST(Jitter, FixedPointsStay) {
  Robot robot = random_voxel_robot({}, 1);
  robot.fixed = {0, 5};
  const std::vector<Vec3> moved = displacements(robot, {.jitter = 1e-3}, 1, 0);
  for (std::size_t i = 0; i < moved.size(); ++i) EXPECT_EQ(moved[i] == Vec3{}, i == 0 || i == 5) << i;
}

TEST(Trials, ARobotIsTakenFromItsSourceOnce) {
  std::map<std::size_t, int> taken;
  const RobotSource robots = [&](std::size_t i) -> std::shared_ptr<const Robot> {
    ++taken[i];
    if (i == 1) throw InputError("robot", "there is none");
    return i < 3 ? std::make_shared<const Robot>(random_voxel_robot({}, 1, i)) : nullptr;
  };
  const RobotSource trials = trial_source(robots, {.trials = 3, .jitter = 1e-3, .delay = 0}, 1);
  const auto first = trials(0);
  EXPECT_EQ(trials(1), first);  // one object
  EXPECT_EQ(trials(2), first);
  for (std::size_t trial = 3; trial < 6; ++trial) EXPECT_THROW(trials(trial), InputError);
  EXPECT_NE(trials(6), first);
  EXPECT_EQ(trials(9), nullptr);
  EXPECT_THAT(taken,
              testing::ElementsAre(testing::Pair(0, 1), testing::Pair(1, 1), testing::Pair(2, 1), testing::Pair(3, 1)));
}

class TrialsOn : public BackendTest {
 protected:
  Evaluation evaluated(std::size_t place, std::size_t of, const TrialSettings& settings, const Environment& world) {
    EvaluationRequest request = trial_request(settings, {.environment = world, .device = device()}, 7);
    const RobotSource robots = [&](std::size_t i) {
      return std::make_shared<const Robot>(random_voxel_robot({}, 1, (i + 1000 - place) % 1000));
    };
    const auto trials = static_cast<std::size_t>(settings.trials);
    Evaluator evaluator(request, trial_source(robots, settings, 7), of * trials);
    std::vector<Evaluation> all;
    while (std::optional<Evaluation> one = evaluator.next()) all.push_back(*std::move(one));
    return all.at(place * trials + 1);
  }
};
INSTANTIATE_TEST_SUITE_P(All, TrialsOn, every_device, BackendTest::name);

TEST_P(TrialsOn, ATrialIsTheSameAloneAndInAnyBatch) {
  const TrialSettings settings{.seconds = 0.3, .trials = 3, .jitter = 1e-3, .delay = 0};
  for (const Environment& world : {Environment(Ocean{}), Environment(Land{})}) {
    const std::uint64_t alone = evaluated(0, 1, settings, world).hash;
    EXPECT_EQ(evaluated(0, 40, settings, world).hash, alone);
    EXPECT_EQ(evaluated(37, 40, settings, world).hash, alone);
  }
}

// A body and a gait that equal their mirror image never leave the mirror's plane. With jitter they do.
TEST_P(TrialsOn, JitterBreaksExactSymmetry) {
  VoxelGrid grid(4, 2, 2, tissue);
  for (int x = 0; x < 4; ++x)
    for (int y = 0; y < 2; ++y) grid.cell(x, y, 0) = static_cast<MaterialId>(1 + x);  // muscles, mirrored in y
  const auto robot = std::make_shared<const Robot>(make_voxel_robot(grid));
  const auto across = [&](double jitter) {
    const TrialSettings settings{.seconds = 2, .jitter = jitter};
    const EvaluationRequest request =
        trial_request(settings, {.dt = 5e-4, .environment = Land{}, .device = device()}, 1);
    Evaluator evaluator(request, source_of({robot}), 1);
    const Evaluation result = evaluator.next().value();
    return std::abs(result.end.center_of_mass.y - result.start.center_of_mass.y);
  };
  EXPECT_GT(across(1e-3), 10 * across(0) + 1e-6f);
}

// Scores are medians of the trials' scores, with their quartiles; values are medians, too.
TEST_P(TrialsOn, AnAssessmentHasTheMedianOfTheTrials) {
  const std::unique_ptr<GenomeSpace> space = make_genome_space({.kind = "voxel"});
  const std::vector<GenomePointer> candidates{space->random(3, 0), space->random(3, 1)};
  TrialSettings settings = search_trials();
  settings.seconds = 0.5;
  settings.trials = 4;
  const Configuration configuration{.environment = Land{}, .device = device()};
  const std::vector<Assessment> assessments =
      make_local_assessor(configuration, settings, {Objective("distance"), Objective("-work")}, 5)
          ->assess(candidates, {}, {})
          .value();
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    const RobotSource robots = [&](std::size_t) {
      return std::make_shared<const Robot>(candidates[c]->grow("candidate"));
    };
    Evaluator evaluator(trial_request(settings, configuration, 5), trial_source(robots, settings, 5), 4);
    std::vector<double> distances, works;
    while (const std::optional<Evaluation> one = evaluator.next()) {
      distances.push_back(quantities()[*find_quantity("distance")].value({*one->robot, *one, configuration}));
      works.push_back(one->work);
    }
    std::ranges::sort(distances);
    std::ranges::sort(works);
    EXPECT_DOUBLE_EQ(assessments[c].scores[0], (distances[1] + distances[2]) / 2);
    EXPECT_DOUBLE_EQ(assessments[c].scores[1], -(works[1] + works[2]) / 2);
    EXPECT_DOUBLE_EQ(assessments[c].lower_quartiles[0], 0.25 * distances[0] + 0.75 * distances[1]);
    EXPECT_DOUBLE_EQ(assessments[c].upper_quartiles[0], 0.75 * distances[2] + 0.25 * distances[3]);
    EXPECT_DOUBLE_EQ(assessments[c].values[*find_quantity("work")], (works[1] + works[2]) / 2);
    EXPECT_EQ(assessments[c].fate, Fate::sound);
    EXPECT_EQ(assessments[c].violation, 0);
  }
}

// A robot that goes straight ahead at two speeds, v for two thirds of the time and w after.
Evaluation gone(const Robot& robot, double v, double w) {
  Evaluation evaluation;
  evaluation.robot = {std::shared_ptr<const Robot>(), &robot};
  evaluation.steps = 9000;
  evaluation.third = 3;
  evaluation.at_third.x = static_cast<float>(3 * v);
  evaluation.at_two_thirds.x = static_cast<float>(6 * v);
  evaluation.end.center_of_mass.x = static_cast<float>(6 * v + 3 * w);
  return evaluation;
}

TEST(CruiseSpeed, IsTheDistanceAfterTheFirstThirdPerItsTime) {
  const Robot robot = make_voxel_robot(VoxelGrid(5, 2, 2, tissue));  // half a meter long
  const Configuration configuration{.dt = 1e-3f};
  const auto value = [&](const char* name, const Evaluation& evaluation) {
    return quantities()[find_quantity(name).value()].value({robot, evaluation, configuration});
  };
  EXPECT_NEAR(value("cruise_speed", gone(robot, 0.2, 0.3)), 0.25, 1e-6);
  EXPECT_NEAR(value("cruise_lengths", gone(robot, 0.2, 0.3)), 0.5, 1e-6);
  EXPECT_EQ(value("steady", gone(robot, 0.2, 0.24)), 1);  // 1/6 apart
  EXPECT_EQ(value("steady", gone(robot, 0.2, 0.26)), 0);  // 3/13 apart
  EXPECT_EQ(value("steady", gone(robot, 0.26, 0.2)), 0);
  Evaluation unknown = gone(robot, 0.2, 0.2);
  unknown.at_third.x = NAN;
  EXPECT_TRUE(std::isnan(value("cruise_speed", unknown)));
  EXPECT_TRUE(std::isnan(value("steady", unknown)));
}

TEST(Limits, RobotsAreRankedByHowMuchTheyBreakThem) {
  const Robot robot = random_voxel_robot({}, 1);
  const auto strained = [&](double strain) {
    Evaluation evaluation;
    evaluation.robot = {std::shared_ptr<const Robot>(), &robot};
    evaluation.largest_strain = strain;
    return evaluation;
  };
  const EvaluationRequest request{.steps = 0};
  const TrialSettings settings = one_trial();
  EXPECT_EQ(fate_of(strained(1.9), request, settings), Fate::sound);
  EXPECT_EQ(violation_of(strained(1.9), request, settings), 0);
  EXPECT_EQ(fate_of(strained(2.1), request, settings), Fate::overstretched);
  EXPECT_NEAR(violation_of(strained(2.1), request, settings), 0.05, 1e-12);
  EXPECT_GT(violation_of(strained(3), request, settings), violation_of(strained(2.1), request, settings));
  EXPECT_TRUE(std::isinf(violation_of(strained(NAN), request, settings)));
  Evaluation exploded = strained(1);
  exploded.end.exploded = true;
  EXPECT_TRUE(std::isinf(violation_of(exploded, request, settings)));
}

TEST(Limits, RobotsOfTheNetworkHaveEnoughMasses) {
  Robot robot = random_voxel_robot({.smallest = {1, 1, 1}, .largest = {1, 1, 1}}, 1);
  ASSERT_EQ(robot.masses.size(), 8u);
  Evaluation evaluation;
  evaluation.robot = {std::shared_ptr<const Robot>(), &robot};
  const EvaluationRequest request{.steps = 0};
  EXPECT_EQ(fate_of(evaluation, request, one_trial()), Fate::sound);  // of voxels
  robot.origin = R"({"kind": "nn"})";
  EXPECT_EQ(fate_of(evaluation, request, one_trial()), Fate::too_small);
  EXPECT_NEAR(violation_of(evaluation, request, one_trial()), 16.0 / 24, 1e-12);
}

TEST(Spread, QuartilesAreThoseOfNumPy) {
  // numpy.quantile([3, 1, 4, 1, 5], [0.25, 0.5, 0.75])
  const Spread spread = spread_of({3, 1, 4, 1, 5});
  EXPECT_EQ(spread, (Spread{.lower_quartile = 1, .median = 3, .upper_quartile = 4}));
  EXPECT_TRUE(std::isnan(spread_of({1, NAN}).median));
  EXPECT_TRUE(std::isnan(spread_of({}).median));
}

}  // namespace
}  // namespace mercury
