// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "mercury/error.h"
#include "mercury/random.h"
#include "robots/nn/exact_geometry.h"
#include "robots/nn/tetrahedra.h"

namespace mercury {
namespace {

using Real = long double;
struct Point {
  Real x, y, z;
};
Point minus(const Vec3& a, const Vec3& b) { return {Real(a.x) - b.x, Real(a.y) - b.y, Real(a.z) - b.z}; }
Real dot_product(const Point& a, const Point& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Point cross_product(const Point& a, const Point& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

Real volume(const std::vector<Vec3>& points, const Tetrahedron& t) {
  const Vec3 o = points[t[0]];
  return dot_product(cross_product(minus(points[t[1]], o), minus(points[t[2]], o)), minus(points[t[3]], o)) / 6;
}

// Center, from the first point, and radius of the sphere through four points.
std::pair<Point, Real> circumscribed_sphere(const std::vector<Vec3>& points, const Tetrahedron& t) {
  const Vec3 o = points[t[0]];
  const Point a = minus(points[t[1]], o), b = minus(points[t[2]], o), c = minus(points[t[3]], o);
  const Point ab = cross_product(a, b), bc = cross_product(b, c), ca = cross_product(c, a);
  const Real aa = dot_product(a, a), bb = dot_product(b, b), cc = dot_product(c, c);
  const Real twelve_volumes = 2 * dot_product(a, bc);
  const Point center = {(aa * bc.x + bb * ca.x + cc * ab.x) / twelve_volumes,
                        (aa * bc.y + bb * ca.y + cc * ab.y) / twelve_volumes,
                        (aa * bc.z + bb * ca.z + cc * ab.z) / twelve_volumes};
  return {center, std::sqrt(dot_product(center, center))};
}

// All tetrahedra whose circumscribed sphere holds no other point, with its radius, from the definition.
std::vector<std::pair<Real, Tetrahedron>> delaunay_by_definition(const std::vector<Vec3>& points) {
  std::vector<std::pair<Real, Tetrahedron>> found;
  const auto n = static_cast<std::uint32_t>(points.size());
  for (std::uint32_t a = 0; a < n; ++a)
    for (std::uint32_t b = a + 1; b < n; ++b)
      for (std::uint32_t c = b + 1; c < n; ++c)
        for (std::uint32_t d = c + 1; d < n; ++d) {
          const Tetrahedron t = {a, b, c, d};
          const auto [center, radius] = circumscribed_sphere(points, t);
          bool empty = true;
          for (std::uint32_t p = 0; p < n && empty; ++p) {
            const Point from_first = minus(points[p], points[a]);
            const Point from_center = {from_first.x - center.x, from_first.y - center.y, from_first.z - center.z};
            const bool own = p == a || p == b || p == c || p == d;
            empty = own || dot_product(from_center, from_center) > radius * radius;
          }
          if (empty) found.emplace_back(radius, t);
        }
  std::sort(found.begin(), found.end());
  return found;
}

std::set<std::set<std::uint32_t>> as_sets(const std::vector<Tetrahedron>& tetrahedra) {
  std::set<std::set<std::uint32_t>> sets;
  for (const Tetrahedron& t : tetrahedra) sets.insert({t.begin(), t.end()});
  return sets;
}

// The set of tetrahedra joined through sides of three common points that has most points; one of them holds `most`.
struct Largest {
  std::set<std::set<std::uint32_t>> tetrahedra;
  std::size_t points = 0;
};
Largest largest_by_merging(const std::vector<Tetrahedron>& all) {
  std::vector<std::set<std::size_t>> groups;
  for (std::size_t i = 0; i < all.size(); ++i) {
    std::set<std::size_t> merged = {i};
    std::erase_if(groups, [&](const std::set<std::size_t>& group) {
      const bool touches = std::any_of(group.begin(), group.end(), [&](std::size_t j) {
        return std::count_if(all[i].begin(), all[i].end(), [&](std::uint32_t p) {
                 return std::find(all[j].begin(), all[j].end(), p) != all[j].end();
               }) == 3;
      });
      if (touches) merged.insert(group.begin(), group.end());
      return touches;
    });
    groups.push_back(merged);
  }
  Largest largest;
  for (const auto& group : groups) {
    std::set<std::uint32_t> points;
    for (const std::size_t i : group) points.insert(all[i].begin(), all[i].end());
    if (points.size() <= largest.points) continue;
    largest = {{}, points.size()};
    for (const std::size_t i : group) largest.tetrahedra.insert({all[i].begin(), all[i].end()});
  }
  return largest;
}

std::vector<Vec3> random_cloud(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Vec3> points(count);
  for (Vec3& p : points)
    p = {static_cast<float>(random.normal()), static_cast<float>(random.normal()), static_cast<float>(random.normal())};
  return points;
}

std::vector<Tetrahedron> no_larger_than(const std::vector<std::pair<Real, Tetrahedron>>& delaunay, Real radius) {
  std::vector<Tetrahedron> result;
  for (const auto& [r, t] : delaunay)
    if (r <= radius) result.push_back(t);
  return result;
}

TEST(AlphaBody, IsTheSmallestOneThatHoldsAllPointsByTheDefinition) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const std::vector<Vec3> points = random_cloud(18, seed);
    const auto delaunay = delaunay_by_definition(points);
    std::optional<Largest> expected;
    Real alpha = 0;
    for (const auto& [radius, t] : delaunay) {
      const Largest largest = largest_by_merging(no_larger_than(delaunay, radius));
      if (largest.points < points.size()) continue;
      expected = largest;
      alpha = radius;
      break;
    }
    ASSERT_TRUE(expected);
    const AlphaBody body = alpha_body(points);
    EXPECT_EQ(as_sets(body.tetrahedra), expected->tetrahedra) << seed;
    EXPECT_NEAR(body.alpha, static_cast<double>(alpha), 1e-6 * body.alpha);
  }
}

TEST(AlphaBody, OfAChosenAlphaIsItsLargestBodyByTheDefinition) {
  int compared = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const std::vector<Vec3> points = random_cloud(18, 100 + seed);
    const auto delaunay = delaunay_by_definition(points);
    const double alpha = 1.1;
    const Largest expected = largest_by_merging(no_larger_than(delaunay, alpha));
    if (expected.points <= points.size() / 2) continue;  // another body could hold as many
    const AlphaBody body = alpha_body(points, alpha);
    EXPECT_EQ(as_sets(body.tetrahedra), expected.tetrahedra) << seed;
    EXPECT_NEAR(body.alpha, alpha, 1e-9);
    ++compared;
  }
  EXPECT_GT(compared, 15);
}

TEST(AlphaBody, HasTetrahedraOfPositiveVolume) {
  const std::vector<Vec3> points = random_cloud(200, 5);
  const AlphaBody body = alpha_body(points);
  for (const Tetrahedron& t : body.tetrahedra) EXPECT_GT(volume(points, t), 0);
}

TEST(AlphaBody, NamesTheNeighborOppositeToEachPoint) {
  const AlphaBody body = alpha_body(random_cloud(200, 6));
  const auto without = [&](std::size_t tetrahedron, std::uint32_t point) {
    std::set<std::uint32_t> side(body.tetrahedra[tetrahedron].begin(), body.tetrahedra[tetrahedron].end());
    side.erase(point);
    return side;
  };
  std::map<std::set<std::uint32_t>, std::set<std::size_t>> holders;  // of a side
  for (std::size_t t = 0; t < body.tetrahedra.size(); ++t)
    for (const std::uint32_t point : body.tetrahedra[t]) holders[without(t, point)].insert(t);
  for (std::size_t t = 0; t < body.tetrahedra.size(); ++t)
    for (std::size_t i = 0; i < 4; ++i) {
      const std::set<std::size_t> expected = holders[without(t, body.tetrahedra[t][i])];
      const std::uint32_t other = body.neighbors[t][i];
      EXPECT_EQ(expected, other == no_neighbor ? std::set<std::size_t>{t} : std::set<std::size_t>({t, other}));
    }
}

TEST(AlphaBody, OfAMirroredCloudIsMirrored) {
  // Radii come in pairs that are equal but round to different numbers.
  for (std::uint64_t seed = 1; seed <= 20; ++seed)
    for (const double alpha : {0., 0.8}) {
      std::vector<Vec3> points;
      for (const Vec3& p : random_cloud(50, 200 + seed)) {
        points.push_back(p);
        points.push_back({p.x, -p.y, p.z});
      }
      const std::set<std::set<std::uint32_t>> body = as_sets(alpha_body(points, alpha).tetrahedra);
      if (alpha > 0 && body.size() < 100) continue;  // one of two mirrored bodies
      // Where points are cospherical the triangulation need not be symmetric. A circle through two pairs is one side of
      // such a place, so a tetrahedron with a point and its image is left out.
      std::size_t compared = 0;
      for (const std::set<std::uint32_t>& t : body) {
        const bool holds_pair = std::any_of(t.begin(), t.end(), [&](std::uint32_t p) { return t.count(p ^ 1u) > 0; });
        if (holds_pair) continue;
        std::set<std::uint32_t> image;
        for (const std::uint32_t p : t) image.insert(p ^ 1u);
        EXPECT_TRUE(body.count(image)) << seed;
        ++compared;
      }
      EXPECT_GT(compared, 50u);
    }
}

TEST(Circumradius, LiesBetweenItsBounds) {
  // From regular tetrahedra to flat and small ones.
  Random random(7);
  std::size_t tight = 0;
  for (int i = 0; i < 20000; ++i) {
    const std::vector<Vec3> points = [&] {
      std::vector<Vec3> corners = random_cloud(4, static_cast<std::uint64_t>(i));
      const auto flatness = static_cast<float>(std::pow(10, -12 * random.uniform()));
      if (i % 4 == 1) corners[3] = 0.5f * (corners[0] + corners[1]) + flatness * corners[3];  // near a side
      if (i % 4 == 2)
        for (Vec3& p : corners) p.z *= flatness;
      if (i % 4 == 3)
        for (Vec3& p : corners) p = flatness * p + Vec3{1, 1, 1};
      return corners;
    }();
    Tetrahedron t = {0, 1, 2, 3};
    const int side = exact_orientation(points[0], points[1], points[2], points[3]);
    if (side == 0) continue;
    if (side < 0) std::swap(t[2], t[3]);
    const ExactSquaredRadius exact(points, t);
    const Bounds bounds = squared_circumradius(points[t[0]], points[t[1]], points[t[2]], points[t[3]]);
    EXPECT_TRUE(exact.compare(bounds.low) >= 0) << i;
    EXPECT_TRUE(!std::isfinite(bounds.high) || exact.compare(bounds.high) <= 0) << i;
    tight += bounds.high - bounds.low < 1e-9 * bounds.low ? 1 : 0;
    EXPECT_TRUE(exact.compare(exact.bounds().low) >= 0);
    EXPECT_TRUE(exact.compare(exact.bounds().high) <= 0);
    EXPECT_NEAR(exact.bounds().high / exact.bounds().low, 1, 1e-15);
    if (i % 4 == 0) {
      const auto radius = static_cast<double>(circumscribed_sphere(points, t).second);
      EXPECT_NEAR(std::sqrt(exact.bounds().low), radius, 1e-6 * radius);
    }
  }
  EXPECT_GT(tight, 10000u);
}

TEST(Circumradius, IsComputedExactlyWhereItsBoundsSayNothing) {
  // Two sides are nearly parallel: n (n + 2) - (n + 1)^2 = -1, of terms near 7e13.
  const float n = 0x1p23f;
  const std::vector<Vec3> points = {{0, 0, 0}, {n + 1, n + 2, 0}, {n, n + 1, 0}, {0, 0, 1}};
  const Bounds bounds = squared_circumradius(points[0], points[1], points[2], points[3]);
  EXPECT_EQ(bounds.low, 0);
  EXPECT_FALSE(std::isfinite(bounds.high));
  const auto radius = static_cast<double>(circumscribed_sphere(points, {0, 1, 2, 3}).second);
  EXPECT_NEAR(alpha_body(points).alpha, radius, 1e-12 * radius);
}

TEST(Circumradius, ComparesExactly) {
  // Edges 1, 1, 1 at a right angle: the squared radius is 3/4, whichever corner comes first.
  const std::vector<Vec3> points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 1 + 0x1p-23f}};
  const ExactSquaredRadius one(points, {0, 1, 2, 3}), turned(points, {1, 3, 2, 0}), larger(points, {0, 1, 2, 4});
  EXPECT_TRUE(one.compare(0.75) == 0);
  EXPECT_TRUE(one.compare(turned) == 0);
  EXPECT_TRUE(one.compare(larger) < 0);
  EXPECT_TRUE(larger.compare(0.75) > 0);
  EXPECT_TRUE(one.compare(std::nextafter(0.75, 1)) < 0);
}

TEST(AlphaBody, OfALatticeIsTheWholeLattice) {
  // Eight points on every sphere: all decisions are ties.
  std::vector<Vec3> points;
  for (int x = 0; x < 4; ++x)
    for (int y = 0; y < 4; ++y)
      for (int z = 0; z < 4; ++z)
        points.push_back({0.1f * static_cast<float>(x), 0.1f * static_cast<float>(y), 0.1f * static_cast<float>(z)});
  const AlphaBody body = alpha_body(points);
  Real sum = 0;
  for (const Tetrahedron& t : body.tetrahedra) sum += volume(points, t);
  EXPECT_NEAR(static_cast<double>(sum), 0.027, 1e-8);
  EXPECT_NEAR(body.alpha, 0.05 * std::sqrt(3.), 1e-7);
}

TEST(AlphaBody, DoesNotDependOnTheOrderOfThePoints) {
  const std::vector<Vec3> points = random_cloud(100, 9);
  std::vector<Vec3> reversed(points.rbegin(), points.rend());
  std::vector<Tetrahedron> renamed;
  for (Tetrahedron t : alpha_body(reversed).tetrahedra) {
    for (std::uint32_t& p : t) p = 99 - p;
    renamed.push_back(t);
  }
  EXPECT_EQ(as_sets(renamed), as_sets(alpha_body(points).tetrahedra));
}

TEST(AlphaBody, RefusesCloudsThatSpanNoBody) {
  const auto refused = [](const std::vector<Vec3>& points, double alpha = 0) {
    EXPECT_THROW(alpha_body(points, alpha), InputError);
  };
  refused({});
  refused({{0, 0, 0}});
  refused({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  refused({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}});
  refused({{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}, {0.5f, 0.25f, 1}});
  refused({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, 0.5);
  EXPECT_EQ(alpha_body(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}).tetrahedra.size(), 1u);
}

}  // namespace
}  // namespace mercury
