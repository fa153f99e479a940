// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/slot_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "sim/physics/measures.h"
#include "tests/sim/bodies.h"

namespace mercury::cuda {
namespace {

SlotOrder order_of(const Robot& robot) { return choose_slots(robot, pair_faces(robot)); }

std::vector<Robot> robots() {
  return {bodies::point(), bodies::random_voxels({.x = 1, .y = 1, .z = 1}, 1),
          bodies::random_voxels({.x = 7, .y = 1, .z = 1}, 1), bodies::random_voxels({.x = 5, .y = 4, .z = 3}, 1),
          bodies::random_voxels({.x = 10, .y = 10, .z = 10}, 1)};
}

TEST(SlotOrder, GivesEachMassASlotOfItsOwn) {
  for (const Robot& robot : robots()) {
    const SlotOrder order = order_of(robot);
    std::vector<std::uint16_t> slots = order.slots, expected(robot.masses.size());
    std::ranges::sort(slots);
    std::iota(expected.begin(), expected.end(), std::uint16_t{0});
    EXPECT_EQ(slots, expected);
    const std::vector<std::uint16_t> masses = order.masses();
    for (std::uint32_t mass = 0; mass < masses.size(); ++mass) EXPECT_EQ(masses.at(order.slot_of(mass)), mass);
  }
}

// The ranges of valences of two tiles meet in one number at most.
TEST(SlotOrder, MassesOfATileHaveAboutTheSameValence) {
  for (const Robot& robot : robots()) {
    const std::vector<std::uint32_t> valence = valences(robot);
    const std::vector<std::uint16_t> masses = order_of(robot).masses();
    std::vector<std::pair<std::uint32_t, std::uint32_t>> ranges(tiles_for(masses.size()), {~0u, 0});
    for (std::size_t slot = 0; slot < masses.size(); ++slot) {
      auto& [least, most] = ranges[slot / lanes];
      least = std::min(least, valence[masses[slot]]);
      most = std::max(most, valence[masses[slot]]);
    }
    std::ranges::sort(ranges);
    for (std::size_t i = 0; i + 1 < ranges.size(); ++i) EXPECT_LE(ranges[i].second, ranges[i + 1].first);
  }
}

// Robots of one topology share an arrangement, so it must not matter which of them is arranged.
TEST(SlotOrder, DoesNotDependOnPositions) {
  const Robot robot = bodies::random_voxels({.x = 4, .y = 5, .z = 6}, 1);
  Robot other = robot;
  bodies::rotate(other, bodies::random_rotation(1));
  EXPECT_EQ(order_of(other).slots, order_of(robot).slots);
}

TEST(DealTiles, GivesWarpsAboutTheSameWork) {
  for (const std::uint32_t tiles : {1u, 2u, 5u, 33u, 42u, 100u})
    for (const std::uint32_t per_warp : {1u, 2u, 3u, 4u}) {
      std::vector<std::uint32_t> work;
      for (std::uint32_t tile = 0; tile < tiles; ++tile) work.push_back(2 * tiles - tile);
      const std::vector<std::uint32_t> position = deal_tiles(work, per_warp);
      std::vector<std::uint32_t> at(tiles, tiles);  // [position]
      for (std::uint32_t tile = 0; tile < tiles; ++tile) at.at(position[tile]) = tile;
      EXPECT_EQ(std::ranges::count(at, tiles), 0);
      EXPECT_EQ(at.back(), tiles - 1);
      std::vector<std::uint32_t> of_warp;
      for (std::uint32_t first = 0; first == 0 || first + per_warp <= tiles; first += per_warp) {
        of_warp.push_back(0);
        for (std::uint32_t i = first; i < std::min(first + per_warp, tiles); ++i) of_warp.back() += work[at[i]];
      }
      // Warps differ by no more than one tile does from another.
      ASSERT_FALSE(of_warp.empty());
      EXPECT_LE(std::ranges::max(of_warp) - std::ranges::min(of_warp), work.front() - work.back());
    }
}

}  // namespace
}  // namespace mercury::cuda
