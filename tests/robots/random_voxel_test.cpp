// SPDX-License-Identifier: Apache-2.0
#include "mercury/random_voxel.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "tests/refusal.h"
#include "tests/robots/surface.h"

namespace mercury {
namespace {

RandomVoxelOptions cube(int n) { return {.smallest = {n, n, n}, .largest = {n, n, n}}; }

double share_of(const VoxelGrid& grid, auto&& condition) {
  return static_cast<double>(std::count_if(grid.cells.begin(), grid.cells.end(), condition)) /
         static_cast<double>(grid.cells.size());
}

TEST(RandomVoxels, TheSameSeedGivesTheSameRobotWhateverThePopulation) {
  const auto few = random_voxel_robots({}, 5, 3);
  const auto many = random_voxel_robots({}, 5, 40);
  for (std::size_t i = 0; i < few.size(); ++i) {
    EXPECT_EQ(few[i], many[i]);
    EXPECT_EQ(few[i], random_voxel_robot({}, 5, i));
  }
  EXPECT_EQ(random_voxel_robots({}, 5, 2, 38)[1], many[39]);
  EXPECT_NE(many[0].masses, random_voxel_robot({}, 6).masses);
  EXPECT_EQ(many[39].name, "voxel-5-39");
}

TEST(RandomVoxels, ARobotsGridInItsOriginMakesItAgain) {
  for (std::uint64_t i = 0; i < 50; ++i) {
    const Robot robot = random_voxel_robot({}, 9, i);
    ASSERT_TRUE(voxel_grid_of(robot).has_value());
    EXPECT_EQ(make_voxel_robot(*voxel_grid_of(robot), {.name = robot.name, .seed = 9, .index = i}), robot);
  }
}

TEST(RandomVoxels, SizesCoverTheRangeThatWasAskedFor) {
  std::set<std::array<int, 3>> sizes;
  for (std::uint64_t i = 0; i < 400; ++i) {
    const VoxelGrid grid = random_voxel_grid({.smallest = {4, 1, 2}, .largest = {6, 1, 3}}, 1, i);
    sizes.insert({grid.nx, grid.ny, grid.nz});
  }
  EXPECT_EQ(sizes, (std::set<std::array<int, 3>>{{4, 1, 2}, {4, 1, 3}, {5, 1, 2}, {5, 1, 3}, {6, 1, 2}, {6, 1, 3}}));
}

TEST(RandomVoxels, TheShareOfAirIsTheOneAskedFor) {
  for (const double air_share : {0.0, 0.25, 0.8}) {
    RandomVoxelOptions options = cube(10);
    options.air = air_share;
    for (std::uint64_t i = 0; i < 20; ++i)
      EXPECT_NEAR(share_of(random_voxel_grid(options, 1, i), [](MaterialId m) { return m == air; }), air_share, 0.002);
  }
}

TEST(RandomVoxels, MirroredHalvesAreAlike) {
  for (const Mirror mirror : {Mirror::x, Mirror::y, Mirror::z}) {
    const RandomVoxelOptions options{.smallest = {3, 4, 5}, .largest = {6, 6, 6}, .mirror = mirror};
    for (std::uint64_t i = 0; i < 50; ++i) {
      const VoxelGrid grid = random_voxel_grid(options, 3, i);
      for (int z = 0; z < grid.nz; ++z)
        for (int y = 0; y < grid.ny; ++y)
          for (int x = 0; x < grid.nx; ++x)
            ASSERT_EQ(grid.at(x, y, z),
                      grid.at(mirror == Mirror::x ? grid.nx - 1 - x : x, mirror == Mirror::y ? grid.ny - 1 - y : y,
                              mirror == Mirror::z ? grid.nz - 1 - z : z));
    }
  }
}

TEST(RandomVoxels, LargerPatchesMeanMoreNeighborsOfOneMaterial) {
  const auto alike = [](int patch) {
    RandomVoxelOptions options = cube(10);
    options.patch = patch;
    options.air = 0;
    options.mirror = Mirror::none;
    int same = 0, pairs = 0;
    for (std::uint64_t i = 0; i < 20; ++i) {
      const VoxelGrid grid = random_voxel_grid(options, 1, i);
      for (int z = 0; z < 10; ++z)
        for (int y = 0; y < 10; ++y)
          for (int x = 0; x < 9; ++x, ++pairs) same += grid.at(x, y, z) == grid.at(x + 1, y, z) ? 1 : 0;
    }
    return same / static_cast<double>(pairs);
  };
  // One frequency and four phases at 0.75, 0.17 tissue, 0.08 bone, drawn apart: 4 (0.75/4)^2 + 0.17^2 + 0.08^2.
  EXPECT_NEAR(alike(1), 0.176, 0.02);
  EXPECT_GT(alike(2), 0.4);
  EXPECT_GT(alike(4), alike(2) + 0.1);
}

TEST(RandomVoxels, MaterialsFollowTheirShares) {
  RandomVoxelOptions options = cube(10);
  options.patch = 1;
  options.air = 0;
  options.mirror = Mirror::none;
  options.muscle = 5, options.tissue = 3, options.bone = 2;
  options.frequencies = 5;
  double muscle = 0, tissues = 0, bones = 0;
  std::set<MaterialId> muscles;
  for (std::uint64_t i = 0; i < 10; ++i) {
    const VoxelGrid grid = random_voxel_grid(options, 2, i);
    muscle += share_of(grid, [](MaterialId m) { return m <= muscle_count; }) / 10;
    tissues += share_of(grid, [](MaterialId m) { return m == tissue; }) / 10;
    bones += share_of(grid, [](MaterialId m) { return m == bone; }) / 10;
    for (const MaterialId m : grid.cells)
      if (m <= muscle_count) muscles.insert(m);
  }
  // 10,000 voxels: a standard deviation of 0.005.
  EXPECT_NEAR(muscle, 0.5, 0.02);
  EXPECT_NEAR(tissues, 0.3, 0.02);
  EXPECT_NEAR(bones, 0.2, 0.02);
  EXPECT_EQ(muscles.size(), 20u);
}

TEST(RandomVoxels, ARobotUsesAsManyFrequenciesAsItMay) {
  RandomVoxelOptions options = cube(8);
  options.patch = 1;
  options.frequencies = 2;
  std::set<int> of_all;
  for (std::uint64_t i = 0; i < 30; ++i) {
    std::set<int> frequencies;
    for (const MaterialId m : random_voxel_grid(options, 4, i).cells)
      if (m >= 1 && m <= muscle_count) frequencies.insert((m - 1) / 4);
    EXPECT_EQ(frequencies.size(), 2u);
    of_all.insert(frequencies.begin(), frequencies.end());
  }
  EXPECT_EQ(of_all.size(), 5u);
}

TEST(RandomVoxels, DefaultsAreSoundBodiesOverManySeeds) {
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    const Robot robot = random_voxel_robot({}, seed);
    ASSERT_NO_THROW(validate(robot));
    ASSERT_TRUE(half_edges_cancel(robot)) << seed;
    ASSERT_TRUE(every_spring_is_there_once(robot)) << seed;
    ASSERT_EQ(spring_components(robot), 1u) << seed;
    ASSERT_GT(enclosed_volume(robot), 0.01) << seed;
  }
}

TEST(RandomVoxels, RefusesOptionsThatCannotBeUsed) {
  const auto message = [](RandomVoxelOptions options) { return refusal([&] { random_voxel_robots(options, 1, 2); }); };
  EXPECT_EQ(message({.smallest = {0, 1, 1}}), "voxels: 0 is not accepted; give 1 or more voxels");
  EXPECT_EQ(message({.smallest = {3, 3, 3}, .largest = {2, 3, 3}}),
            "voxels: 3 to 2 is not accepted; the first size must not be above the second");
  EXPECT_EQ(message({.air = 1}), "air: 1 is not accepted; give at least 0 and below 1");
  EXPECT_EQ(message({.patch = 0}), "patch: 0 is not accepted; give 1 or more voxels");
  EXPECT_EQ(message({.edge = 0}), "edge: 0 is not accepted; give 0.001 to 1000 m");
  EXPECT_EQ(message({.edge = 4294967296}), "edge: 4294967296 is not accepted; give 0.001 to 1000 m");
  EXPECT_EQ(message({.muscle = 0, .tissue = 0, .bone = 0}),
            "muscle, tissue, bone: all are 0; give at least one share above 0");
  EXPECT_EQ(message({.frequencies = 6}), "frequencies: 6 is not accepted; give 1 to 5");
  RandomVoxelOptions huge = cube(50);
  EXPECT_THAT(message(huge), testing::HasSubstr("masses, at most 65535 are accepted"));
}

}  // namespace
}  // namespace mercury
