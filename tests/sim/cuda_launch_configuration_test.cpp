// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/launch_configuration.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace mercury::cuda {
namespace {

// The largest number of tiles that one of a robot's warps has.
std::uint32_t turns_of(std::uint32_t tiles, std::uint32_t warps) {
  std::uint32_t most = 0;
  for (std::uint32_t warp = 0; warp < warps; ++warp)
    most = std::max(most, first_tile_of(warp + 1, tiles, warps) - first_tile_of(warp, tiles, warps));
  return most;
}

constexpr std::uint32_t max_warps = resident_warps / 2;

TEST(LaunchConfiguration, WarpsOfARobotAreTheFewestThatNeedNoMoreTurns) {
  for (std::uint32_t tiles = 1; tiles <= 5 * max_warps; ++tiles)
    for (std::uint32_t share = 1; share <= max_warps; ++share) {
      const std::uint32_t warps = even_warps(tiles, max_warps, share), turns = turns_of(tiles, warps);
      EXPECT_LE(warps, std::min(tiles, max_warps));
      EXPECT_TRUE(warps == 1 || turns_of(tiles, warps - 1) > turns) << tiles << ", " << share;
      EXPECT_LE(turns, std::max(most_turns, turns_of(tiles, std::min(tiles, max_warps)))) << tiles << ", " << share;
    }
}

TEST(LaunchConfiguration, RobotsThatFillTheirShareHaveOneTurn) {
  for (std::uint32_t tiles = 1; tiles <= max_warps; ++tiles) {
    EXPECT_EQ(turns_of(tiles, even_warps(tiles, max_warps, tiles)), 1u);
    EXPECT_EQ(turns_of(tiles, even_warps(tiles, max_warps, std::max(tiles - 1, 1u))), std::min(tiles, 2u));
  }
}

}  // namespace
}  // namespace mercury::cuda
