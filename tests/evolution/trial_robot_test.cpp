// SPDX-License-Identifier: Apache-2.0
#include "evolution/trial_robot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "mercury/cppn.h"
#include "mercury/error.h"
#include "mercury/random_voxel.h"
#include "mercury/real_body.h"
#include "mercury/shell.h"
#include "mercury/voxel.h"

namespace mercury {
namespace {

Robot robot() { return random_voxel_robot({}, 1); }

TEST(TrialRobot, FirstTrialIsTheRobotAsItIs) {
  const Robot first = trial_robot(robot(), {.trials = 3}, 1, 0);
  EXPECT_EQ(first.masses, robot().masses);
  EXPECT_EQ(first.springs, robot().springs);
  EXPECT_TRUE(std::ranges::equal(first.materials, default_materials()));
}

TEST(TrialRobot, LaterTrialsStartAtAnotherMomentOfTheSameMovement) {
  const Robot later = trial_robot(robot(), {.trials = 2}, 1, 1);
  // One delay explains the phases of all muscles.
  std::size_t fitting = 0;
  for (int milliseconds = 1; milliseconds < 100'000; ++milliseconds) {
    bool fits = true;
    for (std::size_t id = 1; fits && id <= muscle_count; ++id) {
      const Material before = default_materials()[id], after = later.materials[id];
      const double difference = before.phase + before.frequency * 1e-3 * milliseconds - after.phase;
      fits = std::abs(std::remainder(difference, 2 * M_PI)) < 3e-3 * before.frequency;
      EXPECT_EQ(before.amplitude, after.amplitude);
      EXPECT_EQ(before.stiffness, after.stiffness);
    }
    fitting += fits;
  }
  EXPECT_THAT(fitting, testing::AllOf(testing::Ge(1u), testing::Lt(200u)));
}

TEST(TrialRobot, TrialsAreTheSameForAllRobotsOfARun) {
  const TrialSettings settings{.trials = 2, .noise = 0.1};
  EXPECT_EQ(trial_robot(robot(), settings, 1, 1).materials,
            trial_robot(random_voxel_robot({}, 2), settings, 1, 1).materials);
  EXPECT_NE(trial_robot(robot(), settings, 1, 1).materials, trial_robot(robot(), settings, 2, 1).materials);
}

TEST(TrialRobot, NoiseScattersStiffnessByItsStandardDeviation) {
  const double noise = 0.05;
  double sum = 0, squares = 0, count = 0;
  for (int trial = 0; trial < 20; ++trial) {
    const Robot noisy = trial_robot(robot(), {.trials = 20, .noise = noise}, 1, trial);
    for (std::size_t id = 1; id < noisy.materials.size(); ++id) {
      const double factor = noisy.materials[id].stiffness / default_materials()[id].stiffness - 1;
      sum += factor, squares += factor * factor, ++count;
    }
  }
  // Five standard errors of the mean and of the standard deviation.
  EXPECT_NEAR(sum / count, 0, 5 * noise / std::sqrt(count));
  EXPECT_NEAR(std::sqrt(squares / count), noise, 5 * noise / std::sqrt(2 * count));
}

TEST(TrialRobot, DamageTakesAboutItsShareOfTheVoxels) {
  const Robot block = make_voxel_robot(VoxelGrid(12, 12, 12, tissue));
  const Robot damaged = trial_robot(block, {.damage = 0.2}, 1, 0);
  const std::optional<VoxelGrid> grid = voxel_grid_of(damaged);
  ASSERT_TRUE(grid);
  const double voxels = 12 * 12 * 12;
  const auto lost = static_cast<double>(std::ranges::count(grid->cells, air));
  // Five standard deviations of the binomial distribution; loose parts go as well, at this share very few.
  EXPECT_NEAR(lost / voxels, 0.2, 5 * std::sqrt(0.2 * 0.8 / voxels) + 0.01);
}

TEST(TrialRobot, PaintedRobotsAreDamagedAndKeepTheirMaterials) {
  Robot painted = random_cppn_robot({.smallest = {8, 6, 6}, .largest = {8, 6, 6}}, 1);
  painted.actuators = actuators_of(painted);
  const Robot damaged = trial_robot(painted, {.damage = 0.1}, 1, 0);
  EXPECT_LT(damaged.springs.size(), painted.springs.size());
  EXPECT_GT(damaged.springs.size(), painted.springs.size() / 3);
  EXPECT_EQ(damaged.materials, painted.materials);
  EXPECT_EQ(damaged.actuators, painted.actuators);
}

// By the ends of each spring, as places.
std::map<std::pair<std::array<float, 3>, std::array<float, 3>>, Material> materials_by_place(const Robot& robot) {
  std::map<std::pair<std::array<float, 3>, std::array<float, 3>>, Material> materials;
  const auto place = [&](std::uint16_t mass) {
    const Vec3 at = robot.masses[mass];
    return std::array{at.x, at.y, at.z};
  };
  for (const Spring& spring : robot.springs)
    materials.insert_or_assign({place(spring.a), place(spring.b)}, materials_of(robot)[spring.material]);
  return materials;
}

TEST(TrialRobot, SpringsOfFieldsKeepTheirMaterialsWhereVoxelsAreLost) {
  const Robot painted =
      random_cppn_robot({.smallest = {8, 6, 6}, .largest = {8, 6, 6}, .muscles = PaintedMuscles::fields}, 1);
  const auto whole = materials_by_place(painted);
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const Robot damaged = trial_robot(painted, {.damage = 0.1}, seed, 0);
    EXPECT_LT(damaged.springs.size(), painted.springs.size());
    EXPECT_GT(damaged.springs.size(), painted.springs.size() / 3);
    for (const auto& [place, material] : materials_by_place(damaged)) ASSERT_EQ(material, whole.at(place));
  }
}

// A real body has a material per number of voxels that share a spring, so those of a damaged one are others.
TEST(TrialRobot, DamagedRealBodiesAreThoseOfTheVoxelsThatAreLeft) {
  Robot paper = make_voxel_robot([] {
    VoxelGrid grid(6, 4, 4, 3);
    for (int x = 0; x < 6; ++x) grid.cell(x, 0, 0) = bone;
    return grid;
  }());
  paper.actuators = actuators_of(paper);
  const RealMaterial material{.modulus = 2e5f};
  const Robot real = with_real_body(paper, material);
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const Robot damaged = trial_robot(real, {.damage = 0.2}, seed, 0);
    const std::optional<VoxelGrid> grid = voxel_grid_of(damaged);
    ASSERT_TRUE(grid);
    Robot left = make_voxel_robot(*grid);
    left.actuators = paper.actuators;
    const Robot expected = with_real_body(left, material);
    EXPECT_EQ(materials_by_place(damaged), materials_by_place(expected));
    EXPECT_EQ(damaged.actuators, expected.actuators);
    EXPECT_EQ(damaged.mass, expected.mass);
  }
  Robot nameless = real;
  nameless.material_names.clear();
  EXPECT_THROW(trial_robot(nameless, {.damage = 0.2}, 1, 0), InputError);
}

TEST(TrialRobot, RobotsWithoutVoxelsCannotBeDamaged) {
  EXPECT_THROW(trial_robot(random_shell_robot({}, 1), {.damage = 0.2}, 1, 0), InputError);
}

}  // namespace
}  // namespace mercury
