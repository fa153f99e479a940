// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/chunks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <map>
#include <tuple>
#include <vector>

#include "sim/cuda/arrangement.h"
#include "sim/physics/fixed_point.h"
#include "tests/sim/bodies.h"

namespace mercury::cuda {
namespace {

// A chunk of springs, filled as for a class whose largest robot has some groups more.
struct Records {
  Records(const Robot& robot, std::uint32_t words) : arrangement(arrange(robot)), words(words) {
    const Schedule& schedule = arrangement.schedule;
    if (words == 1) rest = rest_lengths(robot);
    springs.assign((groups_of(schedule) + 2) * words_of_group(words), 0xffffffff);
    fill_records(springs, robot, schedule, rest);
    groups.resize(schedule.tiles() + 1);
    rows.resize((schedule.tiles() + 1) * lanes);
    fill_rows(groups, rows, schedule);
  }
  // The record of a slot in a row of its tile.
  const std::uint32_t* at(std::uint32_t slot, std::uint32_t row) const {
    const std::size_t group = groups[slot / lanes] + row / rows_at_once;
    return &springs[((group * lanes + slot % lanes) * rows_at_once + row % rows_at_once) * words];
  }
  float rest_length(const std::uint32_t* record) const {
    return words == 1 ? rest.table[record[0] >> 8 & 0xff] : std::bit_cast<float>(record[1]);
  }

  Arrangement arrangement;
  std::uint32_t words;
  RestLengths rest;
  std::vector<std::uint32_t> springs, groups;
  std::vector<SlotRows> rows;
};

std::vector<Robot> robots() {
  return {bodies::random_voxels({.x = 1, .y = 1, .z = 1}, 1), bodies::random_voxels({.x = 5, .y = 3, .z = 4}, 2),
          bodies::random_voxels({.x = 10, .y = 10, .z = 10}, 3)};
}

// Two slots in order, the material and the rest length of a spring, and how many there are.
using Springs = std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, float>, int>;

TEST(Chunks, HaveEachSpringOnceInAGroupOfItsOwnersTile) {
  for (const Robot& robot : robots())
    for (const std::uint32_t words : {1u, 2u}) {
      const Records records(robot, words);
      Springs wanted, found;
      for (const Spring& spring : robot.springs) {
        const std::uint32_t a = records.arrangement.order->slot_of(spring.a),
                            b = records.arrangement.order->slot_of(spring.b);
        ++wanted[{std::min(a, b), std::max(a, b), spring.material, spring.rest_length}];
      }
      for (std::uint32_t slot = 0; slot < records.rows.size(); ++slot)
        for (std::uint32_t row = 0; row < records.rows[slot].count; ++row) {
          const std::uint32_t* record = records.at(slot, row);
          const std::uint32_t partner = record[0] >> 16, material = record[0] & 0xff;
          if (material != air)
            ++found[{std::min(slot, partner), std::max(slot, partner), material, records.rest_length(record)}];
        }
      EXPECT_EQ(found, wanted);
    }
}

// A warp loads whole groups, and contacts look springs up in them.
TEST(Chunks, HaveAirInUnusedRowsAndGroups) {
  for (const Robot& robot : robots())
    for (const std::uint32_t words : {1u, 2u}) {
      const Records records(robot, words);
      std::size_t used = 0;
      for (std::uint32_t slot = 0; slot < records.rows.size(); ++slot) used += records.rows[slot].count * words;
      std::size_t cleared = 0;
      for (const std::uint32_t word : records.springs) cleared += word == 0;
      EXPECT_GE(cleared, records.springs.size() - used);
      for (std::uint32_t slot = 0; slot < records.rows.size(); ++slot)
        for (std::uint32_t row = records.rows[slot].count; row % rows_at_once != 0; ++row)
          EXPECT_EQ(records.at(slot, row)[0], 0u) << "slot " << slot << ", row " << row;
    }
}

// With forces of zero, each row subtracts the constant from its owner's sum and adds it to its partner's.
TEST(Chunks, StartSumsSoThatRoundingConstantsCancel) {
  for (const Robot& robot : robots()) {
    const Records records(robot, 1);
    std::vector<std::uint32_t> sums(records.rows.size());
    constexpr auto constant = std::bit_cast<std::uint32_t>(rounding_magic);
    for (std::uint32_t slot = 0; slot < sums.size(); ++slot) {
      sums[slot] += static_cast<std::uint32_t>(records.rows[slot].bias);
      for (std::uint32_t row = 0; row < records.rows[slot].count; ++row) {
        sums[slot] -= constant;
        sums[records.at(slot, row)[0] >> 16] += constant;
      }
    }
    EXPECT_EQ(sums, std::vector<std::uint32_t>(sums.size()));
  }
}

}  // namespace
}  // namespace mercury::cuda
