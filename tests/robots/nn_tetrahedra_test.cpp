// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "robots/nn/tetrahedra.h"

namespace mercury {
namespace {

using testing::ElementsAre;
using testing::UnorderedElementsAre;

// With the points (0,0,0), (1,0,0), (0,1,0), (0,0,1): outside is away from the point that a side lacks.
TEST(Tetrahedra, SkinOfOneLooksOutward) {
  const std::vector<Tetrahedron> one = {{0, 1, 2, 3}};
  EXPECT_THAT(skin_of(one),
              UnorderedElementsAre(Triangle{0, 2, 1}, Triangle{0, 1, 3}, Triangle{0, 3, 2}, Triangle{1, 2, 3}));
}

TEST(Tetrahedra, ASideBetweenTwoIsNotSkin) {
  // Point 4 lies beyond the side 1-2-3.
  const std::vector<Tetrahedron> two = {{0, 1, 2, 3}, {1, 2, 3, 4}};
  const auto skin = skin_of(two);
  EXPECT_EQ(skin.size(), 6u);
  EXPECT_THAT(skin, testing::Not(testing::Contains(Triangle{1, 2, 3})));
  EXPECT_THAT(skin, testing::Contains(Triangle{1, 2, 4}));
}

TEST(Tetrahedra, SkinFollowsFromTheNeighborsOppositeToEachPoint) {
  const std::vector<Tetrahedron> two = {{0, 1, 2, 3}, {2, 1, 3, 4}};
  const std::uint32_t none = no_neighbor;
  const std::vector<Neighbors> opposite = {{1, none, none, none}, {none, none, none, 0}};
  EXPECT_EQ(skin_of(two, opposite), skin_of(two));
}

TEST(Tetrahedra, StartWithTheLowestPointOnTheSameSide) {
  EXPECT_EQ(lowest_first({0, 1, 2, 3}), (Tetrahedron{0, 1, 2, 3}));
  EXPECT_EQ(lowest_first({1, 0, 3, 2}), (Tetrahedron{0, 1, 2, 3}));  // two swaps
  EXPECT_EQ(lowest_first({3, 1, 2, 0}), (Tetrahedron{0, 1, 3, 2}));  // the mirror image
  EXPECT_EQ(lowest_first({9, 4, 7, 2}), (Tetrahedron{2, 4, 9, 7}));
}

TEST(Tetrahedra, EdgesAreListedOnce) {
  const std::vector<Tetrahedron> two = {{0, 1, 2, 3}, {1, 2, 3, 4}};
  EXPECT_THAT(edges_of(two), ElementsAre(Edge(0, 1), Edge(0, 2), Edge(0, 3), Edge(1, 2), Edge(1, 3), Edge(1, 4),
                                         Edge(2, 3), Edge(2, 4), Edge(3, 4)));
}

TEST(Tetrahedra, EdgesOfAPointWithManyAreSortedToo) {
  // A fan: points 0 and 1 form a tetrahedron with every two neighbors of a ring of 200.
  std::vector<Tetrahedron> fan;
  for (std::uint32_t i = 0; i < 200; ++i) fan.push_back({0, 1, 2 + (77 * i) % 200, 2 + (77 * i + 1) % 200});
  const std::vector<Edge> edges = edges_of(fan);
  EXPECT_EQ(edges.size(), 1u + 200 + 200 + 200);
  EXPECT_TRUE(std::is_sorted(edges.begin(), edges.end()));
  EXPECT_EQ(std::adjacent_find(edges.begin(), edges.end()), edges.end());
}

TEST(Tetrahedra, NeighborsShareASide) {
  const std::vector<Tetrahedron> three = {{0, 1, 2, 3}, {1, 2, 3, 4}, {3, 4, 5, 6}};  // the third shares an edge only
  const auto neighbors = neighbors_of(three);
  EXPECT_EQ(neighbors[0][0], 1u);
  EXPECT_EQ(neighbors[0][1], no_neighbor);
  EXPECT_EQ(neighbors[1][0], 0u);
  EXPECT_EQ(neighbors[2][0], no_neighbor);
}

TEST(Tetrahedra, TheLargestBodyHoldsMostPointsAndIsJoinedBySides) {
  const std::vector<Tetrahedron> tetrahedra = {{4, 5, 6, 7}, {0, 1, 2, 3}, {1, 2, 3, 4}};
  const auto neighbors = neighbors_of(tetrahedra);
  const SolidBody all = largest_body(tetrahedra, neighbors, 3);
  EXPECT_THAT(all.tetrahedra, UnorderedElementsAre(1, 2));
  EXPECT_EQ(all.points, 5u);
  EXPECT_EQ(all.rival, no_neighbor);
  const SolidBody first = largest_body(tetrahedra, neighbors, 2);  // equals: the earliest
  EXPECT_THAT(first.tetrahedra, ElementsAre(0));
  EXPECT_EQ(first.rival, 1u);
  EXPECT_TRUE(largest_body(tetrahedra, neighbors, 0).tetrahedra.empty());
}

TEST(Tetrahedra, ComponentsAreNamedByTheirLowestPoint) {
  const std::vector<Edge> edges = {{4, 5}, {1, 2}, {2, 5}};
  EXPECT_THAT(components(7, edges), ElementsAre(0, 1, 1, 3, 1, 1, 6));
}

}  // namespace
}  // namespace mercury
