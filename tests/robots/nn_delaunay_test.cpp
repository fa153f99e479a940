// SPDX-License-Identifier: Apache-2.0
#include "robots/nn/tetrahedra.h"

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "mercury/random.h"

namespace mercury {
namespace {

using Points = std::vector<Vec3>;
using Tetrahedra = std::set<Tetrahedron>;

Tetrahedra sorted(const std::vector<Tetrahedron>& tetrahedra) {
  Tetrahedra result;
  for (const Tetrahedron& t : tetrahedra) result.insert(lowest_first(t));
  return result;
}

// The triangulation of CGAL, which breaks ties in the same way.
Tetrahedra by_cgal(const Points& points) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  using Vertex = CGAL::Triangulation_vertex_base_with_info_3<std::uint32_t, Kernel>;
  using Cell = CGAL::Delaunay_triangulation_cell_base_3<Kernel>;
  using Delaunay = CGAL::Delaunay_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<Vertex, Cell>>;
  std::vector<std::pair<Kernel::Point_3, std::uint32_t>> indexed;
  for (std::uint32_t i = 0; i < points.size(); ++i) indexed.push_back({{points[i].x, points[i].y, points[i].z}, i});
  const Delaunay delaunay(indexed.begin(), indexed.end());
  Tetrahedra result;
  if (delaunay.dimension() < 3) return result;
  for (const auto cell : delaunay.finite_cell_handles()) {
    Tetrahedron t;
    for (int i = 0; i < 4; ++i) t[static_cast<std::size_t>(i)] = cell->vertex(i)->info();
    result.insert(lowest_first(t));
  }
  return result;
}

Points normal_cloud(std::size_t count, Random& random, bool mirrored = false) {
  Points points;
  const auto next = [&] { return static_cast<float>(random.normal()); };
  while (points.size() < count) {
    const float x = next(), y = next(), z = next();
    points.push_back({x, y, z});
    if (mirrored) points.push_back({x, -y, z});
  }
  return points;
}

// Points of a lattice, each with some probability.
Points holey_lattice(int x, int y, int z, Random& random) {
  Points points;
  for (int i = 0; i < x; ++i)
    for (int j = 0; j < y; ++j)
      for (int k = 0; k < z; ++k)
        if (random.chance(0.7))
          points.push_back(
              {0.25f * static_cast<float>(i), 0.3f * static_cast<float>(j), 0.25f * static_cast<float>(k)});
  return points;
}

Points changed(Points points, auto change) {
  for (Vec3& p : points) change(p);
  return points;
}

// Clouds that are hard on a triangulation.
std::vector<Points> clouds() {
  Random random(1);
  std::vector<Points> all;
  for (const std::size_t count : {4u, 5u, 8u, 30u, 300u}) all.push_back(normal_cloud(count, random));
  for (int i = 0; i < 40; ++i) all.push_back(normal_cloud(4 + 6 * static_cast<std::size_t>(i), random, true));
  for (int i = 0; i < 40; ++i) all.push_back(holey_lattice(2 + i % 5, 2 + i % 3, 2 + i % 4, random));
  const Points cloud = normal_cloud(150, random);
  all.push_back(changed(cloud, [](Vec3& p) { p = (1 / length(p)) * p; }));  // on a sphere
  all.push_back(changed(cloud, [](Vec3& p) { p.z *= 1e-7f; }));             // nearly in a plane
  all.push_back(changed(cloud, [](Vec3& p) { p.x *= 1e-20f, p.y *= 1e-20f; }));
  all.push_back(changed(cloud, [](Vec3& p) { p = 1e-30f * p; }));
  all.push_back(changed(cloud, [](Vec3& p) { p.x = p.x > 0 ? 1.f : 0.f; }));  // in two planes
  all.push_back(changed(normal_cloud(300, random), [](Vec3& p) { p = (1 / length(p)) * p; }));
  all.back().push_back({0.01f, 0, 0});  // its cavity is nearly the whole sphere
  all.push_back({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}, {4, 4, 4.5f}, {1, 1, 0}, {2, 2, 0}, {0, 1, 0}});
  return all;
}

TEST(Delaunay, HasTheTetrahedraThatCgalFindsAlsoWherePointsAreCospherical) {
  std::size_t compared = 0;
  for (const Points& points : clouds()) {
    const Tetrahedra expected = by_cgal(points);
    EXPECT_EQ(sorted(triangulate(points).tetrahedra), expected);
    compared += expected.size();
  }
  EXPECT_GT(compared, 20000u);
}

TEST(Delaunay, DoesNotDependOnTheOrderOfThePoints) {
  Random random(2);
  for (const Points& points : clouds()) {
    std::vector<std::uint32_t> order(points.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    for (std::size_t i = order.size() - 1; i > 0; --i) std::swap(order[i], order[random.below(i + 1)]);
    Points shuffled;
    for (const std::uint32_t i : order) shuffled.push_back(points[i]);
    std::vector<Tetrahedron> renamed = triangulate(shuffled).tetrahedra;
    for (Tetrahedron& t : renamed)
      for (std::uint32_t& p : t) p = order[p];
    EXPECT_EQ(sorted(renamed), sorted(triangulate(points).tetrahedra));
  }
}

TEST(Delaunay, NamesTheNeighborOppositeToEachPoint) {
  for (const Points& points : clouds()) {
    const Triangulation result = triangulate(points);
    for (std::uint32_t t = 0; t < result.tetrahedra.size(); ++t)
      for (std::size_t i = 0; i < 4; ++i) {
        const std::uint32_t other = result.neighbors[t][i];
        if (other == no_neighbor) continue;
        const Tetrahedron& there = result.tetrahedra[other];
        for (std::size_t k = 0; k < 4; ++k)
          EXPECT_EQ(std::count(there.begin(), there.end(), result.tetrahedra[t][k]), k == i ? 0 : 1);
        EXPECT_EQ(std::count(result.neighbors[other].begin(), result.neighbors[other].end(), t), 1);
      }
  }
}

TEST(Delaunay, FillsTheBoxOfALattice) {
  Points points;
  for (int i = 0; i < 5 * 4 * 6; ++i)
    points.push_back({static_cast<float>(i % 5), static_cast<float>(i / 5 % 4), static_cast<float>(i / 20)});
  double sum = 0;
  for (const auto& [a, b, c, d] : triangulate(points).tetrahedra) {
    const double volume = dot(cross(points[b] - points[a], points[c] - points[a]), points[d] - points[a]) / 6.0;
    EXPECT_GT(volume, 0);
    sum += volume;
  }
  EXPECT_NEAR(sum, 4 * 3 * 5, 1e-9);
}

TEST(Delaunay, WorksForLargeCloudsAndForRepeatedPoints) {
  Random random(3);
  Points points = normal_cloud(5000, random, true);
  EXPECT_EQ(sorted(triangulate(points).tetrahedra), by_cgal(points));
  points = normal_cloud(50, random);
  const Tetrahedra once = sorted(triangulate(points).tetrahedra);
  const Points copy = points;
  points.insert(points.end(), copy.begin(), copy.end());
  std::vector<Tetrahedron> twice = triangulate(points).tetrahedra;
  for (Tetrahedron& t : twice)
    for (std::uint32_t& p : t) p %= 50;
  EXPECT_EQ(sorted(twice), once);
}

TEST(Delaunay, IsEmptyInAPlane) {
  EXPECT_TRUE(triangulate({}).tetrahedra.empty());
  EXPECT_TRUE(triangulate(Points{{1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}}).tetrahedra.empty());
  EXPECT_TRUE(triangulate(Points{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}}).tetrahedra.empty());
  EXPECT_TRUE(triangulate(Points{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}, {0.5f, 0.25f, 1}}).tetrahedra.empty());
}

}  // namespace
}  // namespace mercury
