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

// The center of the masses at the start of a trial.
Vec3 center_at_start(const Robot& robot, const TrialSettings& settings, const Environment& environment,
                     std::uint64_t seed, std::size_t trial) {
  std::vector<Vec3> positions = robot.masses;
  begin_trial(robot, settings, environment, seed, trial, positions);
  double sum[3] = {}, mass = 0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const auto m = static_cast<double>(mass_of(robot, i));
    mass += m;
    sum[0] += m * static_cast<double>(positions[i].x);
    sum[1] += m * static_cast<double>(positions[i].y);
    sum[2] += m * static_cast<double>(positions[i].z);
  }
  return {static_cast<float>(sum[0] / mass), static_cast<float>(sum[1] / mass), static_cast<float>(sum[2] / mass)};
}

TEST(StartAroundTheTarget, IsWithinTheRadiusInAnyDirectionAndTheSameForAllRobots) {
  const Robot robot = random_voxel_robot({}, 1), other = make_voxel_robot(VoxelGrid(2, 3, 1, tissue));
  Environment environment = Ocean{};
  environment.target = {5, -3, 2};
  for (const bool sphere : {false, true}) {
    const TrialSettings settings{.target_radius = 3, .target_spread = 0.5, .target_sphere = sphere};
    constexpr int trials = 2000;
    double sum[3] = {}, squares[3] = {}, distances = 0;
    for (int trial = 0; trial < trials; ++trial) {
      const auto number = static_cast<std::size_t>(trial);
      const Vec3 d = center_at_start(robot, settings, environment, 1, number) - environment.target;
      const auto r = static_cast<double>(length(d));
      ASSERT_GE(r, 1.5 - 1e-5);
      ASSERT_LE(r, 3 + 1e-5);
      distances += r / trials;
      const double unit[3] = {d.x / r, d.y / r, d.z / r};
      for (int k = 0; k < 3; ++k) sum[k] += unit[k] / trials, squares[k] += unit[k] * unit[k] / trials;
      if (trial > 20) continue;
      const Vec3 of_other = center_at_start(other, settings, environment, 1, number) - environment.target;
      EXPECT_LT(length(of_other - d), 1e-5f);
      EXPECT_GT(length(center_at_start(robot, settings, environment, 2, number) - environment.target - d), 1e-3f);
    }
    // Five standard errors. A coordinate of a direction on a circle has the mean 0 and the mean square 1/2; on a sphere
    // 1/3; on a circle the third one is 0.
    const double error = 5 / std::sqrt(trials);
    EXPECT_NEAR(distances, 2.25, 0.75 / std::sqrt(3.0) * error);
    for (int k = 0; k < 3; ++k) {
      const double expected = sphere ? 1.0 / 3 : k < 2 ? 0.5 : 0;
      EXPECT_NEAR(sum[k], 0, std::sqrt(expected) * error + 1e-6) << k;
      EXPECT_NEAR(squares[k], expected, 0.36 * error * (expected > 0) + 1e-9) << k;
    }
  }
}

TEST(StartTurned, TurnsABodyAboutTheVerticalThroughItsCenter) {
  const Robot robot = random_voxel_robot({}, 1);
  const TrialSettings settings{.turned = true};
  const Vec3 center = center_at_start(robot, {}, Ocean{}, 1, 0);
  double mean_cosine = 0;
  constexpr int trials = 1000;
  for (int trial = 0; trial < trials; ++trial) {
    std::vector<Vec3> positions = robot.masses;
    begin_trial(robot, settings, Ocean{}, 1, static_cast<std::size_t>(trial), positions);
    const Vec3 before = robot.masses.back() - robot.masses.front(), now = positions.back() - positions.front();
    const double flat = std::hypot(before.x, before.y);
    mean_cosine += (before.x * now.x + before.y * now.y) / (flat * flat) / trials;
    if (trial > 20) continue;
    EXPECT_LT(length(center_at_start(robot, settings, Ocean{}, 1, static_cast<std::size_t>(trial)) - center), 1e-5f);
    for (std::size_t i = 0; i < positions.size(); ++i) {
      EXPECT_EQ(positions[i].z, robot.masses[i].z);
      EXPECT_NEAR(length(positions[i] - positions[0]), length(robot.masses[i] - robot.masses[0]), 1e-5);
    }
  }
  EXPECT_NEAR(mean_cosine, 0, 5 / std::sqrt(2.0 * trials));
}

TEST(NoisePerTrial, TheFirstTrialHasThatOfTheRobotAndEachOtherItsOwn) {
  TrialSettings settings = search_trials();
  const EvaluationRequest request = trial_request(settings, {}, 5);
  ASSERT_TRUE(request.noise_seed);
  EXPECT_EQ(request.noise_seed(0), 0u);
  EXPECT_EQ(request.noise_seed(3), 0u);  // the first trial of the second robot
  EXPECT_NE(request.noise_seed(1), 0u);
  EXPECT_NE(request.noise_seed(1), request.noise_seed(2));
  EXPECT_EQ(request.noise_seed(1), request.noise_seed(4));
  EXPECT_NE(request.noise_seed(1), trial_request(settings, {}, 6).noise_seed(1));
  EXPECT_FALSE(trial_request(TrialSettings{.trials = 3}, {}, 5).noise_seed);  // as runs of earlier versions
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

// Of trials around a target, the mean may count; a share is a mean in any case. A body without muscles stays where it
// is: it has reached what is within half its length from its start.
TEST_P(TrialsOn, AnAssessmentMayHaveTheMeanOfTheTrialsAndHasTheShareThatReachedTheTarget) {
  const Robot block = make_voxel_robot(VoxelGrid(4, 2, 2, tissue));  // 0.4 m long
  const std::unique_ptr<GenomeSpace> space =
      make_genome_space({.kind = "voxel", .environment = "ocean", .founders = {block}});
  const std::vector<GenomePointer> candidates{space->random(1, 0)};
  TrialSettings settings = search_trials();
  settings.seconds = 0.1;
  settings.trials = 40;
  settings.mean = true;
  settings.target_radius = 1;
  settings.target_spread = 1;
  const Configuration configuration{.environment = Ocean{}, .device = device()};
  const Assessment assessed =
      make_local_assessor(configuration, settings, {Objective("-target_nearest"), Objective("reached")}, 5)
          ->assess(candidates, {}, {})
          .value()
          .front();
  double sum = 0, squares = 0, near = 0;
  for (std::size_t trial = 0; trial < 40; ++trial) {
    const auto distance =
        static_cast<double>(length(center_at_start(block, settings, configuration.environment, 5, trial)));
    sum += distance / 40;
    squares += distance * distance / 40;
    near += distance <= 0.2 ? 1.0 / 40 : 0;
  }
  ASSERT_GT(near, 0);
  EXPECT_NEAR(assessed.scores[0], -sum, 1e-4);
  const double error = std::sqrt((squares - sum * sum) / 39);
  EXPECT_NEAR(assessed.upper_quartiles[0] - assessed.scores[0], error, 1e-4);
  EXPECT_NEAR(assessed.scores[0] - assessed.lower_quartiles[0], error, 1e-4);
  EXPECT_NEAR(assessed.scores[1], near, 1e-9);
  EXPECT_NEAR(assessed.values[*find_quantity("reached")], near, 1e-9);
}

void expect_same(const std::optional<std::vector<Assessment>>& found, const std::vector<Assessment>& expected) {
  ASSERT_TRUE(found);
  ASSERT_EQ(found->size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ((*found)[i].fate, expected[i].fate) << i;
    EXPECT_EQ((*found)[i].hash, expected[i].hash) << i;
    EXPECT_EQ((*found)[i].scores, expected[i].scores) << i;
    EXPECT_EQ((*found)[i].interim_scores, expected[i].interim_scores) << i;
  }
}

// Candidates that are prepared, in several calls, have the assessments that they have one by one; limits of racing
// are those of their own call.
TEST_P(TrialsOn, PreparedCandidatesHaveTheSameAssessments) {
  const std::unique_ptr<GenomeSpace> space = make_genome_space({.kind = "voxel"});
  std::vector<std::vector<GenomePointer>> batches(3);
  for (std::size_t i = 0; i < 30; ++i) batches[i % 3].push_back(space->random(7, i));
  const Configuration configuration{.environment = Ocean{}, .device = device()};
  for (const bool racing : {false, true}) {
    TrialSettings settings = search_trials();
    settings.seconds = 0.4;
    settings.trials = racing ? 1 : 2;
    settings.racing = racing;
    const auto make = [&] { return make_local_assessor(configuration, settings, {Objective("distance")}, 5); };
    const std::vector<std::vector<double>> limits{{}, {1e9, 1e9, 1e9}, {0, 0, 0}};
    const auto limits_of = [&](std::size_t i) { return racing ? limits[i] : std::vector<double>(); };
    std::vector<std::vector<Assessment>> expected;
    for (std::size_t i = 0; i < batches.size(); ++i)
      expected.push_back(make()->assess(batches[i], limits_of(i), {}).value());
    const std::unique_ptr<Assessor> assessor = make();
    assessor->prepare(batches[0], limits_of(0));
    for (std::size_t i = 0; i < batches.size(); ++i) {
      if (i + 1 < batches.size()) assessor->prepare(batches[i + 1], limits_of(i + 1));
      expect_same(assessor->assess(batches[i], limits_of(i), {}), expected[i]);
    }
    if (racing) {
      EXPECT_EQ(expected[1].front().fate, Fate::stopped);
    }
    // What was prepared in vain is forgotten, and so is what was interrupted.
    assessor->prepare(batches[2], limits_of(2));
    expect_same(assessor->assess(batches[0], limits_of(0), {}), expected[0]);
    EXPECT_FALSE(assessor->assess(batches[1], limits_of(1), [](std::size_t, std::size_t) { return false; }));
    expect_same(assessor->assess(batches[1], limits_of(1), {}), expected[1]);
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
