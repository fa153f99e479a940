// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/schedule.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <set>

#include "sim/cuda/arrangement.h"
#include "sim/physics/measures.h"
#include "tests/sim/bodies.h"

namespace mercury::cuda {
namespace {

// All springs meet at one mass, the opposite of an even body.
Robot star(int points) {
  Robot robot;
  robot.masses.resize(static_cast<std::size_t>(points) + 1);
  for (int i = 1; i <= points; ++i) {
    robot.masses[static_cast<std::size_t>(i)].x = static_cast<float>(i);
    robot.springs.push_back({0, static_cast<std::uint16_t>(i), 1, static_cast<float>(i)});
  }
  return robot;
}

Robot tangle(int masses, int springs, unsigned seed) {
  std::mt19937 random(seed);
  Robot robot;
  robot.masses.resize(static_cast<std::size_t>(masses));
  for (int s = 0; s < springs; ++s) {
    const auto a = static_cast<std::uint16_t>(random() % static_cast<unsigned>(masses));
    const auto b = static_cast<std::uint16_t>((a + 1 + random() % static_cast<unsigned>(masses - 1)) %
                                              static_cast<unsigned>(masses));
    robot.springs.push_back({a, b, static_cast<MaterialId>(1 + random() % 253), 0.1f + 0.001f * static_cast<float>(s)});
  }
  return robot;
}

// Few of the triangles share an edge, so most are alone in their pair.
Robot triangles(int masses, int count, unsigned seed) {
  Robot robot = tangle(masses, 3 * masses, seed);
  std::mt19937 random(seed);
  for (int i = 0; i < count; ++i) {
    const auto a = random() % static_cast<unsigned>(masses), b = random() % static_cast<unsigned>(masses),
               c = random() % static_cast<unsigned>(masses);
    if (a == b || b == c || c == a) continue;
    robot.faces.push_back(
        {static_cast<std::uint16_t>(a), static_cast<std::uint16_t>(b), static_cast<std::uint16_t>(c)});
  }
  return robot;
}

std::vector<Robot> scheduled_robots() {
  std::vector<Robot> all{bodies::random_voxels({.x = 1, .y = 1, .z = 1}, 1),
                         bodies::random_voxels({.x = 10, .y = 10, .z = 10}, 2),
                         bodies::random_voxels({.x = 17, .y = 2, .z = 3}, 3), star(500)};
  for (unsigned seed = 0; seed < 20; ++seed) all.push_back(tangle(40 + 7 * static_cast<int>(seed), 900, seed));
  all.push_back(tangle(2, 300, 20));  // more colors than a word has bits
  all.push_back(tangle(33, 6000, 21));
  all.push_back(triangles(200, 150, 22));
  all.push_back(bodies::random_voxels({.x = 2, .y = 2, .z = 2}, 23));
  all.push_back(bodies::point());
  return all;
}

std::vector<OwnedSpring> ends_of(const Robot& robot) {
  std::vector<OwnedSpring> ends;
  for (const Spring& spring : robot.springs) ends.push_back({spring.a, spring.b});
  return ends;
}

Schedule schedule_of(const Robot& robot) { return schedule_springs(robot.masses.size(), ends_of(robot)); }

using Key = std::array<float, 4>;  // both masses, material, rest length
Key key(std::uint32_t a, std::uint32_t b, MaterialId material, float rest_length) {
  return {static_cast<float>(std::min(a, b)), static_cast<float>(std::max(a, b)), static_cast<float>(material),
          rest_length};
}

TEST(Schedule, HoldsEverySpringOnceAndNothingElse) {
  for (const Robot& robot : scheduled_robots()) {
    const Schedule schedule = schedule_of(robot);
    std::multiset<Key> expected, found;
    for (const Spring& s : robot.springs) expected.insert(key(s.a, s.b, s.material, s.rest_length));
    for (std::uint32_t tile = 0; tile < schedule.tiles(); ++tile)
      for (std::uint32_t entry = schedule.row_start[tile] * lanes; entry < schedule.row_start[tile + 1] * lanes;
           ++entry) {
        const ScheduledSpring& s = schedule.entries[entry];
        if (s.spring == padding) continue;
        const Spring& spring = robot.springs.at(s.spring);
        found.insert(key(tile * lanes + entry % lanes, s.partner, spring.material, spring.rest_length));
      }
    EXPECT_EQ(found, expected);
  }
}

// But for masses that count as several, which as many lanes may have as their partner.
TEST(Schedule, NoTwoPartnersOfARowShareABank) {
  for (const Robot& robot : scheduled_robots()) {
    const MassBanks banks = choose_owners(robot.masses.size(), ends_of(robot)).banks;
    const Schedule schedule = schedule_of(robot);
    for (std::uint32_t row = 0; row < schedule.rows(); ++row) {
      std::array<std::uint32_t, lanes> uses{};
      for (std::uint32_t lane = 0; lane < lanes; ++lane) {
        const ScheduledSpring& s = schedule.entries[row * lanes + lane];
        uses[s.partner % lanes] += s.spring != padding;
      }
      for (std::uint32_t bank = 0; bank < lanes; ++bank) EXPECT_LE(uses[bank], banks.count(bank)) << "row " << row;
    }
  }
}

// 158 springs of 27 masses need six rows, of which the last is nearly full. The middle mass joins all 26 others: it
// takes part in a row once as an owner and four times as a partner. Those in the middles of the sides, which join 17,
// may be the partners of two.
TEST(Schedule, SmallCubeTakesAsManyRowsAsItsLanesNeed) {
  const Robot cube = bodies::random_voxels({.x = 2, .y = 2, .z = 2}, 1);
  const Schedule schedule = schedule_of(cube);
  const MassBanks banks = choose_owners(cube.masses.size(), ends_of(cube)).banks;
  EXPECT_EQ(schedule.rows(), 6u);
  for (std::uint32_t slot = 0; slot < cube.masses.size(); ++slot)
    EXPECT_EQ(banks.count(slot), schedule.valences[slot] == 26 ? 4u : schedule.valences[slot] == 17 ? 2u : 1u) << slot;
}

// Padding reads a partner like a spring does. Where a tile has all its masses, it must find a free bank.
TEST(Schedule, PaddingOfAFullTileUsesFreeBanks) {
  for (const Robot& robot : scheduled_robots()) {
    const Schedule schedule = schedule_of(robot);
    for (std::uint32_t tile = 0; tile < robot.masses.size() / lanes; ++tile)
      for (std::uint32_t row = schedule.row_start[tile]; row < schedule.row_start[tile + 1]; ++row) {
        std::set<int> banks;
        for (std::uint32_t lane = 0; lane < lanes; ++lane)
          banks.insert(schedule.entries[row * lanes + lane].partner % 32);
        EXPECT_EQ(banks.size(), lanes) << "row " << row;
      }
  }
}

TEST(Schedule, PartnersOfMassesAreMassesAndLanesWithoutAMassReadOneAnother) {
  for (const Robot& robot : scheduled_robots()) {
    const Schedule schedule = schedule_of(robot);
    for (std::uint32_t tile = 0; tile < schedule.tiles(); ++tile)
      for (std::uint32_t entry = schedule.row_start[tile] * lanes; entry < schedule.row_start[tile + 1] * lanes;
           ++entry) {
        const std::uint32_t owner = tile * lanes + entry % lanes, partner = schedule.entries[entry].partner;
        if (owner < robot.masses.size())
          EXPECT_LT(partner, robot.masses.size());
        else
          EXPECT_TRUE(partner >= robot.masses.size() && partner / lanes == tile);
      }
  }
}

TEST(Schedule, CountsTheSpringsOfASlotAndWhatItReceives) {
  for (const Robot& robot : scheduled_robots()) {
    const Schedule schedule = schedule_of(robot);
    std::vector<std::uint32_t> valences(schedule.tiles() * lanes), incoming(valences.size());
    for (const Spring& spring : robot.springs) ++valences[spring.a], ++valences[spring.b];
    for (const ScheduledSpring& entry : schedule.entries) ++incoming[entry.partner];
    EXPECT_EQ(schedule.valences, valences);
    EXPECT_EQ(schedule.incoming_counts, incoming);
  }
}

// Koenig's theorem: a bipartite graph has as many colors as its busiest vertex has edges.
// Or up to three more, where that makes their number a multiple of the rows that are computed at once.
TEST(Schedule, TilesHaveAsManyRowsAsTheirBusiestLaneOrBankHasSprings) {
  for (const Robot& robot : scheduled_robots()) {
    const MassBanks banks = choose_owners(robot.masses.size(), ends_of(robot)).banks;
    const Schedule schedule = schedule_of(robot);
    ASSERT_EQ(schedule.entries.size(), std::size_t{schedule.rows()} * lanes);
    for (std::uint32_t tile = 0; tile < schedule.tiles(); ++tile) {
      std::array<std::uint32_t, lanes> of_lane{};
      std::array<std::uint32_t, lanes + most_extra_banks> of_bank{};
      for (std::uint32_t entry = schedule.row_start[tile] * lanes; entry < schedule.row_start[tile + 1] * lanes;
           ++entry) {
        if (schedule.entries[entry].spring == padding) continue;
        ++of_lane[entry % lanes];
        ++of_bank[banks.bank_of(
            {static_cast<std::uint16_t>(tile * lanes + entry % lanes), schedule.entries[entry].partner})];
      }
      const std::uint32_t rows = schedule.row_start[tile + 1] - schedule.row_start[tile];
      const std::uint32_t needed = std::max(std::ranges::max(of_lane), std::ranges::max(of_bank));
      EXPECT_GE(rows, needed);
      EXPECT_LT(rows, needed + rows_at_once);
    }
  }
}

// A warp computes rows_at_once rows together, and what is left of a tile more slowly.
TEST(Schedule, MostTilesOfALatticeHaveAMultipleOfTheRowsComputedAtOnce) {
  for (const int side : {8, 10}) {
    const Schedule schedule = arrange(bodies::random_voxels({.x = side, .y = side, .z = side}, 7)).schedule;
    std::uint32_t whole = 0;
    for (std::uint32_t tile = 0; tile < schedule.tiles(); ++tile)
      whole += (schedule.row_start[tile + 1] - schedule.row_start[tile]) % rows_at_once == 0;
    EXPECT_GT(2 * whole, schedule.tiles()) << side;
  }
}

TEST(SpringOwners, TwoMassesShareTheirSpringsEvenly) {
  EXPECT_EQ(choose_owners(2, ends_of(tangle(2, 300, 1))).rows, std::vector<std::uint32_t>{150});
  EXPECT_EQ(choose_owners(2, ends_of(tangle(2, 301, 1))).rows, std::vector<std::uint32_t>{151});
}

// A row of the last tile has at most 8 springs here, one of another tile 32.
TEST(SpringOwners, MassesOfAPartlyEmptyTileOwnFewSprings) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    const std::vector<std::uint32_t> rows = choose_owners(72, ends_of(tangle(72, 576, seed))).rows;
    ASSERT_EQ(rows.size(), 3u);
    EXPECT_LT(rows[2], std::min(rows[0], rows[1]) / 2);
  }
}

TEST(Arrangement, HoldsTheSpringsAndFacesOfTheRobot) {
  for (const Robot& robot : scheduled_robots()) {
    const Arrangement arrangement = arrange(robot);
    const std::vector<std::uint16_t> masses = arrangement.order->masses();
    const auto mass_of = [&](std::uint32_t slot) { return masses.at(slot); };
    std::set<std::uint32_t> springs;
    const Schedule& schedule = arrangement.schedule;
    for (std::uint32_t tile = 0; tile < schedule.tiles(); ++tile)
      for (std::uint32_t entry = schedule.row_start[tile] * lanes; entry < schedule.row_start[tile + 1] * lanes;
           ++entry) {
        const ScheduledSpring& s = schedule.entries[entry];
        if (s.spring == padding) continue;
        const std::set<std::uint32_t> ends{mass_of(tile * lanes + entry % lanes), mass_of(s.partner)};
        EXPECT_EQ(ends, (std::set<std::uint32_t>{robot.springs.at(s.spring).a, robot.springs.at(s.spring).b}));
        EXPECT_TRUE(springs.insert(s.spring).second);
      }
    EXPECT_EQ(springs.size(), robot.springs.size());
    std::multiset<std::set<std::uint32_t>> expected, found;
    for (const Face& f : robot.faces) expected.insert({f.a, f.b, f.c});
    for (const FacePair& p : arrangement.faces) {
      if (p.a == p.c) continue;  // padding
      const std::uint32_t a = mass_of(p.a), b = mass_of(p.b), c = mass_of(p.c), d = mass_of(p.d);
      found.insert({a, b, c});
      if (p.d != p.a && p.d != p.c) found.insert({a, c, d});
    }
    for (auto it = found.begin(); it != found.end();) it = it->size() < 3 ? found.erase(it) : std::next(it);
    EXPECT_EQ(found, expected);
  }
}

TEST(Arrangement, WastesLittleOnALattice) {
  for (const int size : {9, 10, 15}) {
    const Robot robot = bodies::random_voxels({.x = size, .y = size, .z = size}, 1);
    const Arrangement arrangement = arrange(robot);
    EXPECT_GT(static_cast<double>(robot.springs.size()), 0.95 * arrangement.schedule.rows() * lanes) << size;
  }
}

// A long chain of cubes. Padding that reads a mass of its tile would be longer than any spring may be.
TEST(Arrangement, PaddingIsNoLongerThanSpringsMayBe) {
  const Robot robot = bodies::random_voxels({.x = 200, .y = 1, .z = 1}, 1);
  const Arrangement arrangement = arrange(robot);
  const std::vector<std::uint16_t> masses = arrangement.order->masses();
  const Schedule& schedule = arrangement.schedule;
  const float limit = measure(robot).squared_stretch_limit();
  std::vector<std::uint32_t> incoming(schedule.tiles() * lanes);
  for (std::uint32_t tile = 0; tile < schedule.tiles(); ++tile)
    for (std::uint32_t entry = schedule.row_start[tile] * lanes; entry < schedule.row_start[tile + 1] * lanes;
         ++entry) {
      const std::uint32_t owner = tile * lanes + entry % lanes, partner = schedule.entries[entry].partner;
      ++incoming[partner];
      if (owner >= masses.size()) continue;
      const Vec3 d = robot.masses.at(masses.at(owner)) - robot.masses.at(masses.at(partner));
      EXPECT_LT(dot(d, d), limit);
    }
  EXPECT_EQ(schedule.incoming_counts, incoming);
}

TEST(Arrangement, FindsTheFirstRobotOfEachTopology) {
  const Robot small = bodies::random_voxels({.x = 3, .y = 3, .z = 3}, 1),
              other = bodies::random_voxels({.x = 3, .y = 3, .z = 2}, 1);
  Robot stronger = small;
  for (Spring& s : stronger.springs) s.material = 7;
  Robot joined = small;
  std::swap(joined.springs.front(), joined.springs.back());
  const std::vector<const Robot*> robots{&small, &other, &stronger, &joined, &other};
  EXPECT_EQ(first_of_topology(robots), (std::vector<std::uint32_t>{0, 1, 0, 3, 1}));
}

}  // namespace
}  // namespace mercury::cuda
