// SPDX-License-Identifier: Apache-2.0
#include "mercury/quantity.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "evolution/selection/behavior.h"
#include "mercury/generator.h"
#include "mercury/random.h"
#include "mercury/voxel.h"

namespace mercury {
namespace {

// A block of 2x3x4 voxels of 0.1 m, tried for 5 s: it went 3 m along x, 4 m along y, -12 m along z.
class OneTrial : public testing::Test {
 protected:
  double value(std::string_view name) const {
    return quantities_of({.robot = robot, .evaluation = evaluation, .configuration = configuration})
        .at(find_quantity(name).value());
  }

  Robot robot = make_voxel_robot(VoxelGrid(2, 3, 4, tissue));
  Configuration configuration{.dt = 0.01};
  Evaluation evaluation{.steps = 500,
                        .start = {.center_of_mass = {1, 1, 1}},
                        .end = {.center_of_mass = {4, 5, -11}},
                        .path = 26,
                        .work = 52,
                        .positive_work = 65,
                        .highest = 1.5,
                        .largest_strain = 0.25,
                        .strained_share = 0.125,
                        .inverted = 0.0625,
                        .overlap = 0.5,
                        .upright = -0.75};
};

TEST_F(OneTrial, MovementIsThatOfTheCenterOfMass) {
  EXPECT_DOUBLE_EQ(value("distance"), 13);
  EXPECT_DOUBLE_EQ(value("seconds"), 5);
  EXPECT_DOUBLE_EQ(value("speed"), 13.0 / 5);
  EXPECT_DOUBLE_EQ(value("speed_x"), 3.0 / 5);
  EXPECT_DOUBLE_EQ(value("speed_y"), 4.0 / 5);
  EXPECT_DOUBLE_EQ(value("speed_z"), -12.0 / 5);
  EXPECT_DOUBLE_EQ(value("path"), 26);
  EXPECT_DOUBLE_EQ(value("straightness"), 0.5);
  EXPECT_DOUBLE_EQ(value("strain"), 0.25);
  EXPECT_DOUBLE_EQ(value("strained_share"), 0.125);
  EXPECT_DOUBLE_EQ(value("inverted"), 0.0625);
  EXPECT_DOUBLE_EQ(value("overlap"), 0.5);
  EXPECT_DOUBLE_EQ(value("upright"), -0.75);
  EXPECT_DOUBLE_EQ(value("work"), 52);
  EXPECT_DOUBLE_EQ(value("positive_work"), 65);
  EXPECT_DOUBLE_EQ(value("absolute_work"), 65 + 13);  // what the muscles took back is 65 - 52
  EXPECT_DOUBLE_EQ(value("efficiency"), 13.0 / 65);
  EXPECT_DOUBLE_EQ(value("height"), 0.5);
  EXPECT_NEAR(value("direction"), 53.130102354155978, 1e-12);  // of the triangle 3, 4, 5
}

// Muscles may take back more than they do. Runs of earlier versions divide by the difference.
TEST_F(OneTrial, NetWorkMayBeNegative) {
  evaluation.work = -52;
  EXPECT_DOUBLE_EQ(value("efficiency"), 13.0 / 65);
  EXPECT_DOUBLE_EQ(value("absolute_work"), 65 + 117);
  const auto efficiency = [&](double work) {
    evaluation.work = work;
    return quantities_of(
               {.robot = robot, .evaluation = evaluation, .configuration = configuration, .net_efficiency = true})
        .at(find_quantity("efficiency").value());
  };
  EXPECT_DOUBLE_EQ(efficiency(52), 13.0 / 52);
  EXPECT_EQ(efficiency(-52), 0);
}

// From (1, 1, 1), 13 m from a target at (4, 5, 13), to a place 24 m below that.
TEST_F(OneTrial, TheTargetIsThatOfTheEnvironment) {
  configuration.environment.target = {4, 5, 13};
  EXPECT_DOUBLE_EQ(value("target_distance"), 24);
  EXPECT_DOUBLE_EQ(value("target_approach"), 13 - 24);
  configuration.environment = Land{};
  configuration.environment.target = {7, 9, 13};
  EXPECT_DOUBLE_EQ(value("target_distance"), 5);
  EXPECT_DOUBLE_EQ(value("target_approach"), 5);
}

TEST_F(OneTrial, OnLandOnlyTheWayAlongTheGroundCounts) {
  configuration.environment = Land{};
  EXPECT_DOUBLE_EQ(value("distance"), 5);
  EXPECT_DOUBLE_EQ(value("speed_z"), -12.0 / 5);
}

TEST_F(OneTrial, ARobotThatStoodStillHasNoNaN) {
  evaluation.end = evaluation.start;
  evaluation.path = 0;
  evaluation.nearest = 0;
  evaluation.steps = 0;
  evaluation.work = 0;
  evaluation.positive_work = 0;
  for (const double v : quantities_of({.robot = robot, .evaluation = evaluation, .configuration = configuration}))
    EXPECT_TRUE(std::isfinite(v));
  EXPECT_EQ(value("straightness"), 0);
  EXPECT_EQ(value("speed"), 0);
  EXPECT_EQ(value("efficiency"), 0);
}

TEST_F(OneTrial, TheTargetIsReachedWithinReachOrHalfTheBodysLength) {
  const double half = value("length") / 2;
  for (const auto& [nearest, reach, reached] :
       {std::tuple{0.99 * half, 0.0f, 1.0}, {1.01 * half, 0.0f, 0.0}, {0.9, 1.0f, 1.0}, {1.1, 1.0f, 0.0}}) {
    evaluation.nearest = nearest;
    configuration.environment.reach = reach;
    EXPECT_EQ(value("target_nearest"), nearest);
    EXPECT_EQ(value("reached"), reached) << nearest << ' ' << reach;
  }
  evaluation.nearest = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isnan(value("reached")));
}

TEST_F(OneTrial, TheBodyIsMeasuredAtRest) {
  EXPECT_EQ(value("masses"), 3 * 4 * 5);
  EXPECT_EQ(value("springs"), static_cast<double>(robot.springs.size()));
  EXPECT_NEAR(value("length"), 0.4, 1e-6);
  EXPECT_NEAR(value("body_height"), 0.4, 1e-6);
  EXPECT_NEAR(value("body_lengths"), 13 / 0.4, 1e-4);
  EXPECT_NEAR(value("size"), 0.2 * 0.3 * 0.4, 1e-7);
  EXPECT_NEAR(value("symmetry"), 1, 1e-5);
  EXPECT_EQ(value("muscle_share"), 0);
  EXPECT_EQ(value("materials"), 1);
}

TEST_F(OneTrial, PairsCountAsTheirBaseMaterials) {
  VoxelGrid grid(2, 1, 1, bone);
  grid.cell(1, 0, 0) = 3;
  robot = make_voxel_robot(grid);
  EXPECT_EQ(value("materials"), 2);
  // All springs of the muscle's voxel, 28, are muscles, those that it shares with the bone as well.
  EXPECT_DOUBLE_EQ(value("muscle_share"), 28.0 / static_cast<double>(robot.springs.size()));
}

TEST(Quantities, NamesAreDifferentWordsOfAFormula) {
  std::set<std::string_view> names;
  for (const Quantity& quantity : quantities()) {
    EXPECT_TRUE(names.insert(quantity.name).second) << quantity.name;
    EXPECT_EQ(quantity.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz_"), std::string_view::npos);
    EXPECT_LT(quantity.usual_lowest, quantity.usual_highest);
    EXPECT_FALSE(quantity.help.empty() || quantity.help.ends_with('.'));
  }
  EXPECT_EQ(find_quantity("beauty"), std::nullopt);
}

// Quantities of the body are the same whatever the robot did; the others differ after another trial.
TEST_F(OneTrial, QuantitiesOfTheBodyDoNotDependOnTheTrial) {
  const std::vector<double> before =
      quantities_of({.robot = robot, .evaluation = evaluation, .configuration = configuration});
  const Evaluation other{.steps = 100,
                         .end = {.center_of_mass = {-1, -1, -1}},
                         .path = 3,
                         .work = 4,
                         .positive_work = 6,
                         .highest = 9,
                         .largest_strain = 0.5,
                         .strained_share = 1,
                         .third = 0.02,
                         .at_two_thirds = {-0.5f, -0.5f, -0.5f}};
  const std::vector<double> after =
      quantities_of({.robot = robot, .evaluation = other, .configuration = configuration});
  for (std::size_t q = 0; q < quantities().size(); ++q)
    EXPECT_EQ(before[q] == after[q], quantities()[q].of_body) << quantities()[q].name;
}

std::vector<Robot> robots_of_all_kinds() {
  std::vector<Robot> robots;
  for (const Generator& generator : generators())
    for (std::uint64_t index = 0; index < 3; ++index) robots.push_back(generator.make({}, "", 1, index));
  return robots;
}

TEST(Body, EveryKindHasAVolumeWithinItsBoxAndASymmetry) {
  for (const Robot& robot : robots_of_all_kinds()) {
    const Vec3 box = box_of(robot);
    EXPECT_GT(volume_of(robot), 0) << robot.name;
    EXPECT_LE(volume_of(robot), static_cast<double>(box.x) * box.y * box.z * 1.0001) << robot.name;
    EXPECT_THAT(mirror_symmetry(robot), testing::AllOf(testing::Ge(0), testing::Le(1))) << robot.name;
  }
}

TEST(Body, VolumeOfAVoxelRobotIsThatOfItsVoxels) {
  VoxelGrid grid(4, 3, 3, tissue);
  grid.cell(1, 1, 1) = grid.cell(0, 0, 0) = air;  // a cave, and a notch
  EXPECT_NEAR(volume_of(make_voxel_robot(grid)), 34 * 0.001, 1e-7);
}

// The same number by comparing all masses with all.
double symmetry_by_definition(const Robot& robot) {
  float lowest = robot.masses[0].y, highest = lowest;
  for (const Vec3& x : robot.masses) lowest = std::min(lowest, x.y), highest = std::max(highest, x.y);
  double reach = 0;
  for (const Spring& spring : robot.springs) reach += spring.rest_length;
  reach /= 2 * static_cast<double>(robot.springs.size());
  double sum = 0;
  for (const Vec3& x : robot.masses) {
    double nearest = reach;
    for (const Vec3& other : robot.masses)
      nearest = std::min(
          nearest, std::hypot(static_cast<double>(other.x) - x.x, static_cast<double>(lowest) + highest - x.y - other.y,
                              static_cast<double>(other.z) - x.z));
    sum += 1 - nearest / reach;
  }
  return sum / static_cast<double>(robot.masses.size());
}

TEST(Body, SymmetryIsThatOfTheDefinition) {
  double lowest = 1;
  for (const Robot& robot : robots_of_all_kinds()) {
    EXPECT_NEAR(mirror_symmetry(robot), symmetry_by_definition(robot), 1e-9) << robot.name;
    lowest = std::min(lowest, mirror_symmetry(robot));
  }
  EXPECT_LT(lowest, 0.9);
}

TEST(Body, SymmetryOfALatticeIsTheShareOfMassesWithAPartner) {
  VoxelGrid grid(2, 3, 1, tissue);
  grid.cell(1, 0, 0) = air;  // its corner (x = 2, y = 0) is gone, so that of y = 3 has no partner: 2 of 22 masses
  EXPECT_NEAR(mirror_symmetry(make_voxel_robot(grid)), 20.0 / 22, 1e-5);
}

TEST(Body, ACloudAndItsMirrorImageAreSymmetric) {
  Random random(1);
  Robot robot;
  for (int i = 0; i < 300; ++i) {
    const auto coordinate = [&] { return static_cast<float>(random.uniform(-1, 1)); };
    const Vec3 x{coordinate(), coordinate(), coordinate()};
    robot.masses.push_back(x);
    robot.masses.push_back({x.x, -x.y, x.z});
  }
  for (std::uint16_t i = 0; i + 1 < 600; ++i)
    robot.springs.push_back({i, static_cast<std::uint16_t>(i + 1), tissue, 0.2f});
  EXPECT_NEAR(mirror_symmetry(robot), 1, 1e-5);
  for (std::size_t i = 0; i < 300; ++i) robot.masses[2 * i].z += 10;  // no mirror image has a partner
  EXPECT_NEAR(mirror_symmetry(robot), symmetry_by_definition(robot), 1e-9);
  EXPECT_LT(mirror_symmetry(robot), 0.3);
}

TEST(Body, SymmetryBearsWhatIsFarAway) {
  Robot robot = make_voxel_robot(VoxelGrid(2, 2, 2, tissue));
  robot.masses.push_back({1e6f, -1e6f, 1e6f});
  EXPECT_GE(mirror_symmetry(robot), 0);
  EXPECT_EQ(mirror_symmetry({}), 1);
  EXPECT_EQ(mirror_symmetry({.masses = {{1, 2, 3}}}), 1);
}

}  // namespace
}  // namespace mercury
