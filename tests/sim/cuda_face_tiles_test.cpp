// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/face_tiles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

#include "tests/sim/bodies.h"
#include "tests/sim/cuda_passes.h"

namespace mercury::cuda {
namespace {

std::vector<Robot> tiled_robots() {
  return {bodies::random_voxels({.x = 1, .y = 1, .z = 1}, 1), bodies::random_voxels({.x = 4, .y = 3, .z = 5}, 1),
          bodies::random_voxels({.x = 10, .y = 10, .z = 10}, 2), bodies::random_voxels({.x = 15, .y = 15, .z = 2}, 2),
          // more than 64 face tiles
          bodies::random_voxels({.x = 40, .y = 30, .z = 1}, 3), bodies::point()};
}

TEST(FaceTiles, HoldEveryFaceOnce) {
  for (const Robot& robot : tiled_robots()) {
    std::multiset<std::set<int>> expected, found;
    for (const Face& f : robot.faces) expected.insert({f.a, f.b, f.c});
    for (const FacePair& p : make_face_tiles(pair_faces(robot))) {
      if (p == padding_faces) continue;
      found.insert({p.a, p.b, p.c});
      if (p.d != p.a && p.d != p.c) found.insert({p.a, p.c, p.d});
    }
    std::erase_if(found, [](const std::set<int>& corners) { return corners.size() < 3; });
    EXPECT_EQ(found, expected);
  }
}

TEST(FaceTiles, AreAsFewAsCanBe) {
  for (const Robot& robot : tiled_robots()) {
    const std::vector<FacePair> given = pair_faces(robot), pairs = make_face_tiles(given);
    EXPECT_EQ(pairs.size(), (given.size() + 31) / 32 * 32);
    const auto unused = static_cast<std::size_t>(std::ranges::count(pairs, padding_faces));
    EXPECT_EQ(pairs.size() - unused, given.size());
  }
}

// A face tile takes a pass per column, and however pairs are dealt out, each corner in the busiest bank takes one pass
// of an addition.
TEST(FaceTiles, TakeFewPassesMoreThanNecessary) {
  for (const Robot& robot : tiled_robots()) {
    const std::vector<FacePair> given = pair_faces(robot);
    CornerBanks banks;
    for (const FacePair& p : given) banks.add(p);
    const std::uint32_t fewest = banks.fewest_passes(given.size());
    const Passes passes = passes_of(make_face_tiles(given));
    EXPECT_GE(passes.additions, fewest);
    EXPECT_GE(passes.reads, (given.size() + 31) / 32 * 4);
    EXPECT_LE(passes.all(), 1.8 * 9 * fewest) << given.size();
  }
}

// 32 pairs whose corners lie in 32 different banks fit into one tile without a conflict, in any order.
TEST(FaceTiles, WithoutConflictsTakeAPassPerColumn) {
  std::vector<FacePair> pairs;
  for (std::uint16_t i = 0; i < 64; ++i) {
    const auto a = static_cast<std::uint16_t>(i / 32 * 128 + i * 7 % 32);
    pairs.push_back({a, static_cast<std::uint16_t>(a + 32), static_cast<std::uint16_t>(a + 64),
                     static_cast<std::uint16_t>(a + 96)});
  }
  const Passes passes = passes_of(make_face_tiles(pairs));
  EXPECT_EQ(passes.reads, 8u);
  EXPECT_EQ(passes.additions, 8u);
}

// Two pairs have the same a and the same c, in the same bank. Only if they keep these in the same columns, a read takes
// one pass.
TEST(FaceTiles, PairsWithACommonMassReadItInOnePass) {
  std::vector<FacePair> pairs;
  for (std::uint16_t i = 0; i < 32; ++i) {
    const auto a = static_cast<std::uint16_t>(i / 2);
    pairs.push_back({a, static_cast<std::uint16_t>(64 + i), static_cast<std::uint16_t>(32 + a),
                     static_cast<std::uint16_t>(96 + i)});
  }
  const Passes passes = passes_of(make_face_tiles(pairs));
  EXPECT_EQ(passes.reads, 4u);
  EXPECT_EQ(passes.additions, 6u);
}

}  // namespace
}  // namespace mercury::cuda
