// SPDX-License-Identifier: Apache-2.0
#include "mercury/voxel_evolution.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "mercury/origin.h"
#include "tests/refusal.h"
#include "tests/robots/surface.h"

namespace mercury {
namespace {

VoxelGrid parent_of(std::uint64_t seed) {
  return random_voxel_grid({.smallest = {6, 5, 4}, .largest = {6, 5, 4}}, seed);
}

std::size_t differences(const VoxelGrid& a, const VoxelGrid& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.cells.size(); ++i) count += a.cells[i] != b.cells[i] ? 1 : 0;
  return count;
}

bool is_mirrored_along_y(const VoxelGrid& grid) {
  for (int z = 0; z < grid.nz; ++z)
    for (int y = 0; y < grid.ny; ++y)
      for (int x = 0; x < grid.nx; ++x)
        if (grid.at(x, y, z) != grid.at(x, grid.ny - 1 - y, z)) return false;
  return true;
}

TEST(VoxelMutation, ChangesNothingWhereItsChancesAreZero) {
  EXPECT_EQ(mutate(parent_of(1), {.flip = 0, .swaps = 0}, 5), parent_of(1));
}

TEST(VoxelMutation, TheSameSeedGivesTheSameChild) {
  const VoxelMutation mutation{.flip = 0.2, .swaps = 3};
  EXPECT_EQ(mutate(parent_of(1), mutation, 5), mutate(parent_of(1), mutation, 5));
  EXPECT_NE(mutate(parent_of(1), mutation, 5), mutate(parent_of(1), mutation, 6));
}

TEST(VoxelMutation, FlipsAsManyVoxelsAsItsChanceSays) {
  const VoxelGrid parent(20, 20, 20, 1);
  // No voxel can be drawn with its old material, so every draw shows. 8,000 voxels: a standard deviation of 0.0034.
  const VoxelGrid child = mutate(parent, {.flip = 0.1, .air = 0.25, .swaps = 0, .materials = {7, 22}}, 3);
  EXPECT_NEAR(static_cast<double>(differences(parent, child)) / 8000, 0.1, 0.015);
  const auto count = [&](MaterialId m) { return std::count(child.cells.begin(), child.cells.end(), m); };
  EXPECT_NEAR(static_cast<double>(count(air)) / 8000, 0.025, 0.008);
  EXPECT_NEAR(static_cast<double>(count(7)) / 8000, 0.0375, 0.009);
  EXPECT_NEAR(static_cast<double>(count(22)) / 8000, 0.0375, 0.009);
}

TEST(VoxelMutation, ASwapMovesVoxelsButMakesNone) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    VoxelGrid parent = parent_of(seed);
    VoxelGrid child = mutate(parent, {.flip = 0, .swaps = 1, .patch = 3}, seed);
    EXPECT_LE(differences(parent, child), 2u * 27u);
    std::sort(parent.cells.begin(), parent.cells.end());
    std::sort(child.cells.begin(), child.cells.end());
    EXPECT_EQ(parent.cells, child.cells);
  }
}

TEST(VoxelMutation, AlwaysChangesTheBody) {
  // By few flips, by a swap alone, and where a draw hardly ever changes anything.
  for (const VoxelMutation& mutation :
       {VoxelMutation{}, VoxelMutation{.flip = 0, .swaps = 1}, VoxelMutation{.flip = 1e-9, .swaps = 0},
        VoxelMutation{.flip = 1e-9, .swaps = 0, .mirror = Mirror::y}})
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
      const VoxelGrid parent = parent_of(seed), child = mutate(parent, mutation, seed);
      ASSERT_NE(largest_body(child), largest_body(parent)) << seed;
      ASSERT_EQ(child, mutate(parent, mutation, seed));
      ASSERT_TRUE(mutation.mirror == Mirror::none || is_mirrored_along_y(child));
    }
}

TEST(VoxelMutation, ChangesOneVoxelWhereChanceChangesNone) {
  const VoxelGrid parent(3, 3, 3, 4);  // swaps leave it alone
  const VoxelGrid child = mutate(parent, {.flip = 0, .swaps = 2}, 5);
  EXPECT_EQ(differences(parent, child), 1u);
  EXPECT_EQ(std::count(child.cells.begin(), child.cells.end(), air), 0);
}

TEST(VoxelMutation, KeepsTheResultOfASeedThatChangesTheBody) {
  // Computed by version 0.2.0.
  const VoxelGrid child = mutate(VoxelGrid(4, 2, 2, 1), {.flip = 0.5, .swaps = 1}, 3);
  EXPECT_THAT(child.cells, testing::ElementsAre(1, 15, 1, 1, 0, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1));
}

TEST(VoxelMutation, KeepsTheHalvesAlikeOnRequest) {
  for (std::uint64_t seed = 0; seed < 50; ++seed)
    ASSERT_TRUE(is_mirrored_along_y(mutate(parent_of(seed), {.flip = 0.3, .swaps = 4, .mirror = Mirror::y}, seed)));
}

TEST(VoxelMutation, LeavesABody) {
  // Every draw turns all voxels to air.
  const VoxelGrid child = mutate(VoxelGrid(2, 2, 2, 3), {.flip = 1, .air = 1}, 1);
  EXPECT_EQ(differences(child, VoxelGrid(2, 2, 2, 3)), 1u);
  EXPECT_EQ(std::count(child.cells.begin(), child.cells.end(), air), 0);
}

TEST(VoxelMutation, CopiesABodyThatCannotChange) {
  const VoxelGrid only(1, 1, 1, 3);
  EXPECT_EQ(mutate(only, {.flip = 1, .materials = {3}}, 1), only);
}

TEST(VoxelCrossover, EveryVoxelComesFromAParent) {
  const VoxelGrid a(6, 5, 4, 1), b(6, 5, 4, 2);
  int of_b = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const VoxelGrid child = cross(a, b, seed);
    for (int z = 0; z < 4; ++z)
      for (int y = 0; y < 5; ++y)
        for (int x = 0; x < 6; ++x) {
          const MaterialId material = child.at(x, y, z);
          ASSERT_TRUE(material == 1 || material == 2);
          // Whole blocks of 2x2x2 have one parent.
          ASSERT_EQ(material, child.at(x / 2 * 2, y / 2 * 2, z / 2 * 2));
          of_b += material - 1;
        }
  }
  // 3 x 3 x 2 blocks in each of 200 children, some cut by the rim.
  EXPECT_NEAR(of_b / (200.0 * 120), 0.5, 0.05);
}

TEST(VoxelCrossover, ASmallerParentLiesInTheMiddle) {
  const VoxelGrid a(6, 5, 4, 1), b(2, 3, 2, 2);
  VoxelGrid all_b_could_give = a;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const VoxelGrid child = cross(a, b, seed);
    for (std::size_t i = 0; i < child.cells.size(); ++i)
      if (child.cells[i] == 2) all_b_could_give.cells[i] = 2;
  }
  for (int z = 0; z < 4; ++z)
    for (int y = 0; y < 5; ++y)
      for (int x = 0; x < 6; ++x)
        EXPECT_EQ(all_b_could_give.at(x, y, z), x >= 2 && x < 4 && y >= 1 && y < 4 && z >= 1 && z < 3 ? 2 : 1);
  EXPECT_EQ(cross(b, a, 1).nx, 2);
}

TEST(VoxelCrossover, OfMirroredParentsIsMirrored) {
  for (std::uint64_t seed = 0; seed < 50; ++seed)
    ASSERT_TRUE(is_mirrored_along_y(cross(parent_of(seed), random_voxel_grid({}, seed), seed, 2, Mirror::y)));
}

TEST(VoxelEvolution, ChildrenKeepMaterialsAndEnvironment) {
  const auto defaults = default_materials();
  std::vector<Material> table(defaults.begin(), defaults.end());
  table[1].frequency = 9;
  std::vector<std::string> names(table.size(), "m");
  const Robot a =
      make_voxel_robot(parent_of(1), {.name = "a", .environment = "land", .materials = table, .material_names = names});
  const Robot b = random_voxel_robot({}, 2);
  for (const Robot& child : {mutate_voxel_robot(a, {}, 7, "child"), cross_voxel_robots(a, b, 7, "child")}) {
    EXPECT_NO_THROW(validate(child));
    EXPECT_EQ(child.name, "child");
    EXPECT_EQ(child.materials, table);
    EXPECT_EQ(child.material_names, names);
    EXPECT_EQ(environment_of(child), "land");
    EXPECT_EQ(kind_of(child), "voxel");
    EXPECT_TRUE(voxel_grid_of(child).has_value());
    EXPECT_TRUE(half_edges_cancel(child));
    EXPECT_EQ(spring_components(child), 1u);
  }
}

TEST(VoxelEvolution, ManyGenerationsStaySound) {
  VoxelGrid grid = parent_of(1);
  for (std::uint64_t generation = 0; generation < 300; ++generation) {
    grid = cross(mutate(grid, {.flip = 0.05, .swaps = 2}, generation), parent_of(generation), generation);
    const Robot robot = make_voxel_robot(grid);
    ASSERT_NO_THROW(validate(robot));
    ASSERT_TRUE(half_edges_cancel(robot));
    ASSERT_EQ(spring_components(robot), 1u);
  }
}

TEST(VoxelEvolution, RefusesWhatItCannotUse) {
  const auto mutation = [&](const VoxelMutation& options) {
    return refusal([&] { mutate(parent_of(1), options, 1); });
  };
  EXPECT_EQ(mutation({.flip = 1.5}), "flip: give a chance between 0 and 1");
  EXPECT_EQ(mutation({.patch = 0}), "patch: give at least 1 voxel");
  EXPECT_EQ(mutation({.materials = {0}}), "materials: 0 is not a base material; give 1 to 22");
  EXPECT_EQ(refusal([] {
              mutate_voxel_robot(Robot{.name = "blob", .masses = {{0, 0, 0}}}, {}, 1, "x");
            }),
            "robot blob: not a voxel robot, its origin holds no grid");
}

TEST(Origin, ReturnsKindAndEnvironmentOfTheOutermostObjectOnly) {
  const Robot robot{.origin = R"({"weights":[[1,2],{"kind":"no"}],"kind":"nn","environment":"land"})"};
  EXPECT_EQ(kind_of(robot), "nn");
  EXPECT_EQ(environment_of(robot), "land");
  EXPECT_EQ(environment_of(Robot{}), "");
  EXPECT_EQ(environment_of(Robot{.origin = R"({"kind":3,"environment":["x"]})"}), "");
  EXPECT_EQ(kind_of(Robot{.origin = "nonsense"}), "");
}

}  // namespace
}  // namespace mercury
