// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/rest_lengths.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/sim/bodies.h"

namespace mercury::cuda {
namespace {

// A chain whose springs have `count` different rest lengths, each of them twice, the longest first.
Robot chain(int count) {
  Robot robot;
  robot.masses.resize(static_cast<std::size_t>(2 * count) + 1);
  for (int i = 0; i < 2 * count; ++i)
    robot.springs.push_back({static_cast<std::uint16_t>(i), static_cast<std::uint16_t>(i + 1), 1,
                             0.1f * static_cast<float>(count - i % count)});
  return robot;
}

TEST(RestLengths, TableIsAscendingAndIndicesLeadToTheLengths) {
  for (const Robot& robot : {chain(1), chain(30), chain(63), bodies::random_voxels({.x = 6, .y = 5, .z = 4}, 1)}) {
    const RestLengths lengths = rest_lengths(robot);
    EXPECT_EQ(lengths.table.front(), 0);
    EXPECT_TRUE(std::ranges::is_sorted(lengths.table, std::less_equal<>()));
    ASSERT_EQ(lengths.index.size(), robot.springs.size());
    for (std::size_t i = 0; i < robot.springs.size(); ++i)
      EXPECT_EQ(lengths.table.at(lengths.index[i]), robot.springs[i].rest_length);
  }
  EXPECT_EQ(rest_lengths(chain(50)).table.size(), 51u);
}

// 6 bits number 0 and 63 others.
TEST(RestLengths, NoIndicesWithMoreThan64Lengths) {
  EXPECT_EQ(rest_lengths(chain(63)).table.size(), 64u);
  for (const int count : {64, 700}) {
    EXPECT_EQ(rest_lengths(chain(count)).table.size(), 65u);
    EXPECT_TRUE(rest_lengths(chain(count)).index.empty());
  }
}

}  // namespace
}  // namespace mercury::cuda
