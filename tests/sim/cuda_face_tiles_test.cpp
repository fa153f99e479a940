// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/face_tiles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>
#include <vector>

#include "tests/sim/bodies.h"

namespace mercury::cuda {
namespace {

std::vector<Robot> robots() {
  return {bodies::random_voxels({.x = 1, .y = 1, .z = 1}, 1), bodies::random_voxels({.x = 4, .y = 3, .z = 5}, 1),
          bodies::random_voxels({.x = 10, .y = 10, .z = 10}, 2), bodies::random_voxels({.x = 15, .y = 15, .z = 2}, 2),
          // more than 64 face tiles
          bodies::random_voxels({.x = 40, .y = 30, .z = 1}, 3), bodies::point()};
}

// The passes that the columns of face tiles take: as many as the busiest bank of a column has masses.
std::uint32_t passes_of(const std::vector<FacePair>& pairs) {
  std::uint32_t passes = 0;
  for (std::size_t first = 0; first < pairs.size(); first += lanes) {
    std::array<std::array<std::uint32_t, lanes>, 4> uses{};
    for (std::size_t i = first; i < first + lanes; ++i) {
      const FacePair& p = pairs[i];
      if (p == padding_faces) continue;
      const std::array<std::uint16_t, 4> corners{p.a, p.b, p.c, p.d};
      for (std::size_t column = 0; column < 4; ++column) ++uses[column][corners[column] % lanes];
    }
    for (const auto& column : uses) passes += std::ranges::max(column);
  }
  return passes;
}

TEST(FaceTiles, HoldEveryFaceOnce) {
  for (const Robot& robot : robots()) {
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
  for (const Robot& robot : robots()) {
    const std::vector<FacePair> given = pair_faces(robot), pairs = make_face_tiles(given);
    EXPECT_EQ(pairs.size(), (given.size() + 31) / 32 * 32);
    const auto unused = static_cast<std::size_t>(std::ranges::count(pairs, padding_faces));
    EXPECT_EQ(pairs.size() - unused, given.size());
  }
}

// Nothing is below this bound: a face tile takes a pass per column, and however pairs are dealt out, each mass of the
// busiest bank takes one.
TEST(FaceTiles, TakeFewPassesMoreThanNecessary) {
  for (const Robot& robot : robots()) {
    const std::vector<FacePair> given = pair_faces(robot);
    CornerBanks banks;
    for (const FacePair& p : given) banks.add(p);
    const std::uint32_t passes = passes_of(make_face_tiles(given)), fewest = banks.fewest_passes(given.size());
    EXPECT_GE(passes, fewest);
    EXPECT_LE(passes, 1.8 * fewest) << given.size();
  }
}

// 32 pairs whose corners lie in 32 different banks fit into one tile without a conflict, in any order.
TEST(FaceTiles, WithoutConflictsTakeAPassPerColumn) {
  std::vector<FacePair> pairs;
  for (std::uint16_t i = 0; i < 64; ++i) {
    const auto bank = static_cast<std::uint16_t>(i * 7 % 32);
    pairs.push_back({bank, static_cast<std::uint16_t>(32 + bank), static_cast<std::uint16_t>(64 + bank),
                     static_cast<std::uint16_t>(96 + bank)});
  }
  EXPECT_EQ(passes_of(make_face_tiles(pairs)), 8u);
}

}  // namespace
}  // namespace mercury::cuda
