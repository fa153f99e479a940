#include "sim/cuda/schedule.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <random>
#include <set>

#include "tests/sim/bodies.h"

namespace mercury::cuda {
namespace {

// Masses in a row of which many hang on the first: the opposite of an even body.
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
    const auto b = static_cast<std::uint16_t>((a + 1 + random() % static_cast<unsigned>(masses - 1)) % static_cast<unsigned>(masses));
    robot.springs.push_back({a, b, static_cast<MaterialId>(1 + random() % 253), 0.1f + 0.001f * static_cast<float>(s)});
  }
  return robot;
}

std::vector<Robot> robots() {
  std::vector<Robot> all{bodies::random_voxels({.x = 1, .y = 1, .z = 1}, 1), bodies::random_voxels({.x = 10, .y = 10, .z = 10}, 2),
                         bodies::random_voxels({.x = 17, .y = 2, .z = 3}, 3), star(500)};
  for (unsigned seed = 0; seed < 20; ++seed) all.push_back(tangle(40 + 7 * static_cast<int>(seed), 900, seed));
  all.push_back(bodies::point());
  return all;
}

using Key = std::array<float, 4>;  // both masses, material, rest length
Key key(std::uint32_t a, std::uint32_t b, MaterialId material, float rest_length) {
  return {static_cast<float>(std::min(a, b)), static_cast<float>(std::max(a, b)), static_cast<float>(material), rest_length};
}

TEST(Schedule, HoldsEverySpringOnceAndNothingElse) {
  for (const Robot& robot : robots()) {
    const Schedule schedule = schedule_springs(robot);
    std::multiset<Key> expected, found;
    for (const Spring& s : robot.springs) expected.insert(key(s.a, s.b, s.material, s.rest_length));
    for (std::uint32_t g = 0; g < schedule.groups(); ++g)
      for (std::uint32_t place = schedule.row_start[g] * lanes; place < schedule.row_start[g + 1] * lanes; ++place) {
        const ScheduledSpring& s = schedule.places[place];
        if (s.material == air) {
          EXPECT_EQ(s.rest_length, 0);
        } else {
          found.insert(key(g * lanes + place % lanes, s.partner, s.material, s.rest_length));
        }
      }
    EXPECT_EQ(found, expected);
  }
}

TEST(Schedule, NoTwoSpringsOfARowWantOneBank) {
  for (const Robot& robot : robots()) {
    const Schedule schedule = schedule_springs(robot);
    for (std::uint32_t row = 0; row < schedule.rows(); ++row) {
      std::set<int> banks;
      for (std::uint32_t lane = 0; lane < lanes; ++lane) {
        const ScheduledSpring& s = schedule.places[row * lanes + lane];
        if (s.material != air) {
          EXPECT_TRUE(banks.insert(s.partner % 32).second) << "row " << row;
        }
      }
    }
  }
}

// An empty place is read like a spring; if it were farther from its owner than a spring may be long, the robot would
// seem to explode.
TEST(Schedule, EmptyPlacesLookAtTheirOwnerOrANeighbour) {
  for (const Robot& robot : robots()) {
    std::map<std::uint32_t, std::set<std::uint32_t>> neighbours;
    for (const Spring& s : robot.springs) {
      neighbours[s.a].insert(s.b);
      neighbours[s.b].insert(s.a);
    }
    const Schedule schedule = schedule_springs(robot);
    for (std::uint32_t g = 0; g < schedule.groups(); ++g)
      for (std::uint32_t place = schedule.row_start[g] * lanes; place < schedule.row_start[g + 1] * lanes; ++place) {
        const ScheduledSpring& s = schedule.places[place];
        const std::uint32_t owner = g * lanes + place % lanes;
        if (s.material != air) continue;
        if (owner < robot.masses.size()) {
          EXPECT_TRUE(s.partner == owner || neighbours[owner].contains(s.partner));
        } else {  // a lane of no mass looks at memory of no mass
          EXPECT_TRUE(s.partner >= robot.masses.size() && s.partner / lanes == g);
        }
      }
  }
}

TEST(Schedule, WastesLittleOnALattice) {
  const Robot robot = bodies::random_voxels({.x = 10, .y = 10, .z = 10}, 1);
  const Schedule schedule = schedule_springs(robot);
  EXPECT_GT(static_cast<double>(robot.springs.size()), 0.85 * schedule.rows() * lanes);
}

TEST(FacePairs, HoldEveryFaceOnceWithoutBankConflicts) {
  for (const Robot& robot : robots()) {
    std::multiset<std::set<int>> expected, found;
    for (const Face& f : robot.faces) expected.insert({f.a, f.b, f.c});
    const std::vector<FacePair> pairs = spread_over_banks(pair_faces(robot));
    for (std::size_t first = 0; first < pairs.size(); first += lanes) {
      std::array<std::set<int>, 4> banks;
      for (std::size_t i = first; i < std::min(first + lanes, pairs.size()); ++i) {
        const FacePair& p = pairs[i];
        if (p.a == p.b) continue;  // empty
        const std::array<std::uint16_t, 4> corners{p.a, p.b, p.c, p.d};
        for (std::size_t column = 0; column < 4; ++column) EXPECT_TRUE(banks[column].insert(corners[column] % 32).second);
        if (std::set<int>{p.a, p.b, p.c}.size() == 3) found.insert({p.a, p.b, p.c});
        if (std::set<int>{p.a, p.c, p.d}.size() == 3) found.insert({p.a, p.c, p.d});
      }
    }
    EXPECT_EQ(found, expected);
  }
}

}  // namespace
}  // namespace mercury::cuda
