// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/slot_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

#include "sim/cuda/arrangement.h"
#include "sim/cuda/launch_configuration.h"
#include "sim/physics/measures.h"
#include "tests/sim/bodies.h"
#include "tests/sim/cuda_passes.h"

namespace mercury::cuda {
namespace {

SlotOrder order_of(const Robot& robot) { return choose_slots(robot, pair_faces(robot)); }

std::vector<Robot> ordered_robots() {
  return {bodies::point(), bodies::random_voxels({.x = 1, .y = 1, .z = 1}, 1),
          bodies::random_voxels({.x = 7, .y = 1, .z = 1}, 1), bodies::random_voxels({.x = 5, .y = 4, .z = 3}, 1),
          bodies::random_voxels({.x = 10, .y = 10, .z = 10}, 1)};
}

TEST(SlotOrder, GivesEachMassASlotOfItsOwn) {
  for (const Robot& robot : ordered_robots()) {
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
  for (const Robot& robot : ordered_robots()) {
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

Schedule schedule_in_order_of_masses(const Robot& robot) {
  std::vector<OwnedSpring> springs;
  for (const Spring& s : robot.springs) springs.push_back({s.a, s.b});
  return schedule_springs(robot.masses.size(), springs);
}

// Masses of low numbers have far more springs than those of high numbers, and equal ones are far apart.
Robot uneven(int masses, int springs, unsigned seed) {
  std::mt19937 random(seed);
  const auto below = [&](int end) { return static_cast<int>(random() % static_cast<unsigned>(end)); };
  Robot robot;
  robot.masses.resize(static_cast<std::size_t>(masses));
  for (int i = 0; i < springs; ++i) {
    const int a = below(1 + below(masses)), b = (a + 1 + below(masses - 1)) % masses;
    robot.springs.push_back(
        {static_cast<std::uint16_t>(a * 7 % masses), static_cast<std::uint16_t>(b * 7 % masses), 1});
  }
  return robot;
}

TEST(SlotOrder, TakesFewerRowsThanTheOrderOfTheMasses) {
  for (const int masses : {50, 117, 300})
    for (unsigned seed = 0; seed < 5; ++seed) {
      const Robot robot = uneven(masses, 8 * masses, seed);
      EXPECT_LT(arrange(robot).schedule.rows(), schedule_in_order_of_masses(robot).rows()) << masses;
    }
}

// A full lattice gains least. Its faces have fewer conflicts in the order of the masses, its springs have more.
TEST(SlotOrder, TakesNoMorePassesThanTheOrderOfTheMasses) {
  for (const int size : {1, 3, 5, 6, 10}) {
    const Robot robot = bodies::random_voxels({.x = size, .y = size, .z = size}, 1);
    const Arrangement arrangement = arrange(robot);
    const auto passes = [](const Schedule& schedule, const std::vector<FacePair>& faces) {
      return 10 * schedule.rows() + passes_of(faces).all();  // docs/performance.md
    };
    EXPECT_LE(passes(arrangement.schedule, arrangement.faces),
              passes(schedule_in_order_of_masses(robot), make_face_tiles(pair_faces(robot))))
        << size;
  }
}

TEST(DealTiles, GivesWarpsAboutTheSameWork) {
  for (const std::uint32_t tiles : {1u, 2u, 5u, 33u, 42u, 100u})
    for (const std::uint32_t warps : {1u, 2u, 3u, 4u, 14u, 28u}) {
      if (warps > tiles) continue;
      std::vector<std::uint32_t> work;
      for (std::uint32_t tile = 0; tile < tiles; ++tile) work.push_back(2 * tiles - tile);
      const std::vector<std::uint32_t> position = deal_tiles(work, warps);
      std::vector<std::uint32_t> at(tiles, tiles);  // [position]
      for (std::uint32_t tile = 0; tile < tiles; ++tile) at.at(position[tile]) = tile;
      EXPECT_EQ(std::ranges::count(at, tiles), 0);
      EXPECT_EQ(at.back(), tiles - 1);
      std::vector<std::uint32_t> of_warp;
      for (std::uint32_t warp = 0; warp < warps; ++warp) {
        const std::uint32_t first = first_tile_of(warp, tiles, warps), end = first_tile_of(warp + 1, tiles, warps);
        EXPECT_TRUE(end - first == tiles / warps || end - first == divide_up(tiles, warps));
        of_warp.push_back(0);
        for (std::uint32_t i = first; i < end; ++i) of_warp.back() += work[at[i]];
      }
      // Warps of as many tiles differ by no more than one tile does from another; others by a tile more.
      const std::uint32_t one_tile = tiles % warps == 0 ? 0 : work.front();
      EXPECT_LE(std::ranges::max(of_warp) - std::ranges::min(of_warp), work.front() - work.back() + one_tile);
    }
}

TEST(Arrangement, FollowsFromTheTopologyWhateverTheShape) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const Robot robot = bodies::random_voxels({.x = 4, .y = 3, .z = 3}, seed);
    Robot upside_down = robot;
    for (Vec3& x : upside_down.masses) x = {x.x, -x.y, -x.z};
    ASSERT_NE(pair_faces(robot), pair_faces(upside_down));
    const Arrangement one = arrange(robot), other = arrange(upside_down);
    EXPECT_EQ(one.order->slots, other.order->slots);
    EXPECT_EQ(one.faces, other.faces);
    EXPECT_EQ(one.schedule.row_start, other.schedule.row_start);
  }
}

}  // namespace
}  // namespace mercury::cuda
