// SPDX-License-Identifier: Apache-2.0
// The order in which the CPU evaluates pairs of faces (sim/cpu/layout/spring_schedule.h).
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "bench/cpu_lattice.h"
#include "sim/cpu/layout/spring_schedule.h"
#include "sim/physics/fixed_point.h"

namespace mercury {
namespace {

// The masses at a pair's corners, and its dither.
using Evaluated = std::array<std::uint32_t, 5>;

std::vector<Evaluated> evaluated_pairs(const cpu::FaceSchedule& schedule, const cpu::Slots& slots, std::size_t count) {
  std::vector<Evaluated> all;
  const auto add = [&](std::array<std::uint32_t, 4> corners, std::uint32_t dither) {
    Evaluated pair{};
    for (std::size_t k = 0; k < 4; ++k) pair[k] = slots.mass_at[corners[k]];
    pair[4] = dither;
    all.push_back(pair);
  };
  const std::uint32_t* dither = schedule.dither.data();
  for (const auto& [corners, lanes] : schedule.runs) {
    for (std::uint32_t lane = 0; lane < slots.lanes; ++lane)
      if ((lanes >> lane & 1) != 0)
        add({corners[0] + lane, corners[1] + lane, corners[2] + lane, corners[3] + lane}, dither[lane]);
    dither += slots.lanes;
  }
  std::size_t left = count - all.size();  // the others of the last tile have no area
  for (std::size_t first = 0; first < schedule.tiles.size(); first += 4 * slots.lanes) {
    const std::uint32_t* const tile = schedule.tiles.data() + first;
    for (std::size_t lane = 0; lane < slots.lanes && left > 0; ++lane, --left)
      add({tile[lane] / 4, tile[slots.lanes + lane] / 4, tile[2 * slots.lanes + lane] / 4,
           tile[3 * slots.lanes + lane] / 4},
          dither[lane]);
    dither += slots.lanes;
  }
  std::ranges::sort(all);
  return all;
}

std::vector<Evaluated> wanted_pairs(const std::vector<FacePair>& pairs) {
  std::vector<Evaluated> all;
  for (std::uint32_t i = 0; i < pairs.size(); ++i)
    all.push_back({pairs[i].a, pairs[i].b, pairs[i].c, pairs[i].d, dither_of_pair(i)});
  std::ranges::sort(all);
  return all;
}

// The last one has a face twice.
std::vector<Robot> robots() {
  std::vector<Robot> all{bench::lattice(1), bench::lattice(5), bench::lattice_with_holes(6, 0.3, 1),
                         bench::scrambled(bench::lattice(4), 1), bench::lattice(3)};
  const std::vector<Face> faces = all.back().faces;
  all.back().faces.insert(all.back().faces.end(), faces.begin(), faces.begin() + 8);
  return all;
}

TEST(FaceSchedule, HasEachPairOnce) {
  for (const std::size_t lanes : {4u, 8u, 16u})
    for (const Robot& robot : robots()) {
      const std::vector<FacePair> pairs = pair_faces(robot);
      const cpu::Slots slots = cpu::assign_slots(robot, lanes);
      const cpu::FaceSchedule schedule = cpu::schedule_faces(pairs, {}, slots);
      EXPECT_EQ(evaluated_pairs(schedule, slots, pairs.size()), wanted_pairs(pairs));
      EXPECT_EQ(schedule.dither.size(), lanes * (schedule.runs.size() + schedule.gathered_tiles(lanes)));
    }
}

// Masses are numbered along x first, so the corners of pairs stand side by side on the four sides along x.
TEST(FaceSchedule, HasFourSidesOfALatticeInRuns) {
  constexpr std::size_t lanes = 8, n = 10, pairs_per_side = n * n;
  const Robot robot = bench::lattice(n);
  const cpu::Slots slots = cpu::assign_slots(robot, lanes);
  const cpu::FaceSchedule schedule = cpu::schedule_faces(pair_faces(robot), {}, slots);
  // Of each ten pairs in a line, those after the eighth may be gathered.
  EXPECT_LE(schedule.gathered_tiles(lanes) * lanes, 2 * pairs_per_side + 4 * pairs_per_side * 2 / n + lanes);
  EXPECT_LE(schedule.runs.size(), 4 * pairs_per_side / lanes + 4 * n);
}

}  // namespace
}  // namespace mercury
