// SPDX-License-Identifier: Apache-2.0
#include "sim/physics/face_pairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "tests/sim/bodies.h"

namespace mercury {
namespace {

using Corners = std::set<std::uint16_t>;
Corners corners(const Face& face) { return {face.a, face.b, face.c}; }

Corners common(const Corners& a, const Corners& b) {
  Corners both;
  std::ranges::set_intersection(a, b, std::inserter(both, both.end()));
  return both;
}

// Faces between masses at random: edges with one, two or more faces, and faces that share two edges.
Robot random_faces(unsigned masses, unsigned faces, unsigned seed) {
  std::mt19937 random(seed);
  Robot robot;
  for (unsigned i = 0; i < masses; ++i)
    robot.masses.push_back(
        {static_cast<float>(random() % 3), static_cast<float>(random() % 3), static_cast<float>(random() % 3)});
  while (robot.faces.size() < faces) {
    const auto mass = [&] { return static_cast<std::uint16_t>(random() % masses); };
    const Face face{mass(), mass(), mass()};
    if (corners(face).size() == 3) robot.faces.push_back(face);
  }
  return robot;
}

// The two faces of each pair, in the order of the pairs: of all pairs of unmatched faces that follow each other at an
// edge, the one that is closest in the file comes next. Compares every face with every other.
std::vector<std::array<Corners, 2>> expected_pairs(const Robot& robot) {
  using Edge = std::pair<std::uint16_t, std::uint16_t>;          // the lower mass first
  using Candidate = std::tuple<std::size_t, std::size_t, Edge>;  // how far apart, the first face, the edge
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < robot.faces.size(); ++i)
    for (const auto& [p, q] : {std::pair{robot.faces[i].a, robot.faces[i].b},
                               {robot.faces[i].b, robot.faces[i].c},
                               {robot.faces[i].c, robot.faces[i].a}})
      for (std::size_t j = i + 1; j < robot.faces.size(); ++j)
        if (common({p, q}, corners(robot.faces[j])).size() == 2) {
          candidates.push_back({j - i, i, std::minmax({p, q})});
          break;
        }
  std::ranges::sort(candidates);
  std::vector<std::array<Corners, 2>> pairs;
  std::set<std::size_t> matched;
  for (const auto& [apart, first, edge] : candidates)
    if (!matched.contains(first) && !matched.contains(first + apart)) {
      matched.insert({first, first + apart});
      pairs.push_back({corners(robot.faces[first]), corners(robot.faces[first + apart])});
    }
  for (std::size_t f = 0; f < robot.faces.size(); ++f)
    if (!matched.contains(f)) pairs.push_back({corners(robot.faces[f]), Corners{}});
  return pairs;
}

// Trajectories do not depend on the order of pairs, but lockstep groups and recorded figures do.
TEST(FacePairs, AreTheClosestFacesInTheFileThatShareAnEdge) {
  std::vector<Robot> robots{bodies::random_voxels({.x = 3, .y = 2, .z = 4}, 1), bodies::point()};
  for (unsigned seed = 0; seed < 50; ++seed) robots.push_back(random_faces(4 + seed % 13, 3 * seed, seed));
  for (const Robot& robot : robots) {
    const std::vector<std::array<Corners, 2>> expected = expected_pairs(robot);
    const std::vector<FacePair> pairs = pair_faces(robot);
    ASSERT_EQ(pairs.size(), expected.size());
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const Corners abc{pairs[i].a, pairs[i].b, pairs[i].c}, acd{pairs[i].a, pairs[i].c, pairs[i].d};
      if (expected[i][1].empty()) {
        EXPECT_EQ(abc, expected[i][0]);
        EXPECT_EQ(pairs[i].d, pairs[i].a);
      } else if (expected[i][0] == expected[i][1]) {
        EXPECT_EQ(abc, expected[i][0]);
      } else {
        EXPECT_TRUE((abc == expected[i][0] && acd == expected[i][1]) ||
                    (abc == expected[i][1] && acd == expected[i][0]));
      }
    }
  }
}

TEST(FacePairs, VertexOrderFollowsFromThePositions) {
  const Robot robot = random_faces(30, 200, 7);
  const auto key = [&](std::uint16_t mass) {
    const Vec3 x = robot.masses[mass];
    return std::tuple(x.z, x.y, x.x, mass);
  };
  for (const FacePair& p : pair_faces(robot))
    if (p.d != p.a) {
      EXPECT_LT(key(p.a), key(p.c));
      EXPECT_LE(key(p.b), key(p.d));
    }
}

}  // namespace
}  // namespace mercury
