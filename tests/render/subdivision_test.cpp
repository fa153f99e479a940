// SPDX-License-Identifier: Apache-2.0
#include "render/subdivision.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>
#include <vector>

#include "render/vector.h"

namespace mercury::render {
namespace {

// A regular octahedron.
const std::vector<float> corners{1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1};
const std::vector<std::uint32_t> faces{0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};

BodyData octahedron() {
  const std::vector<std::uint32_t> materials{7, 1, 2, 3, 4, 5, 6, 8};
  const std::array bodies{prepare_body({.rest_positions = corners, .faces = faces, .face_materials = materials})};
  return *assemble(bodies);
}

std::vector<Vector3> points_of(const FineSkin& fine) {
  std::vector<Vector3> points;
  std::size_t begin = 0;
  for (const std::uint32_t end : fine.means.ends) {
    Vector3 sum(0, 0, 0);
    float weights = 0;
    for (; begin < end; ++begin) {
      sum += fine.means.weights[begin] * Vector3(corners.data() + 3 * fine.means.masses[begin]);
      weights += fine.means.weights[begin];
    }
    EXPECT_NEAR(weights, 1, 1e-5f);
    points.push_back(sum);
  }
  return points;
}

TEST(Subdivision, IsAClosedSkinOfFourTimesAsManyFaces) {
  for (int times = 1; times <= 3; ++times) {
    const FineSkin fine = subdivided(octahedron(), times);
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (std::size_t f = 0; f + 2 < fine.bodies.faces.size(); f += 3)
      for (std::size_t i = 0; i < 3; ++i)
        EXPECT_TRUE(edges.emplace(fine.bodies.faces[f + i], fine.bodies.faces[f + (i + 1) % 3]).second);
    for (const auto& [a, b] : edges) EXPECT_TRUE(edges.contains({b, a}));  // seen from outside on either side
    const std::size_t count = fine.bodies.faces.size() / 3;
    EXPECT_EQ(count, std::size_t(8) << 2 * times);
    EXPECT_EQ(fine.means.ends.size() + count - edges.size() / 2, 2u);  // Euler
    EXPECT_EQ(fine.bodies.records.front().material, 7u);
  }
}

// Loop's rules by hand: a corner with four neighbors keeps 1 - 4 w with w = (5/8 - (3/8)^2) / 4, so it moves to
// 0.515625 of its distance (its neighbors' mean is the middle); a new point on an edge is at 3/8 of both ends, and the
// corners across cancel.
TEST(Subdivision, FollowsLoopsRules) {
  const std::vector<Vector3> points = points_of(subdivided(octahedron(), 1));
  ASSERT_EQ(points.size(), 18u);
  // Before, the corners move 6 tenths of what they will lose the other way.
  const float widened = 1 + 0.6f * (1 - 0.515625f);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(points[i].norm(), 0.515625f * widened, 1e-5f);
  for (std::size_t i = 6; i < 18; ++i) EXPECT_NEAR(points[i].norm(), 0.375f * std::sqrt(2.0f) * widened, 1e-5f);
}

// A face that is there twice is drawn once; its copy has no size, and no part in normals.
TEST(Subdivision, EachFaceStandsForTheOneThatItIsAPartOf) {
  std::vector<std::uint32_t> twice(faces.begin(), faces.begin() + 3);
  twice.insert(twice.end(), faces.begin(), faces.end());
  std::vector<std::uint32_t> materials;
  for (std::uint32_t i = 0; i < twice.size() / 3; ++i) materials.push_back(i);
  const std::array bodies{prepare_body({.rest_positions = corners, .faces = twice, .face_materials = materials}),
                          prepare_body({.rest_positions = corners, .faces = faces})};
  const BodyData coarse = *assemble(bodies);
  const FineSkin fine = subdivided(coarse, 2);
  EXPECT_EQ(fine.bodies.face_offsets, (std::vector<std::uint32_t>{0, 9 * 16, 17 * 16}));
  for (std::uint32_t i = 0; i < 9 * 16; ++i)
    EXPECT_EQ(fine.bodies.records[i].material, coarse.records[i / 16].material);
  std::size_t sized = 0;
  for (std::size_t f = 0; f < fine.bodies.faces.size(); f += 3)
    sized += fine.bodies.faces[f] != fine.bodies.faces[f + 1];
  EXPECT_EQ(sized, 16u * 16);
  EXPECT_EQ(fine.bodies.mass_faces.size(), 3 * sized);
}

TEST(Subdivision, ASmootherSkinIsRounder) {
  const auto ratio = [](int times) {
    float nearest = 1e9f, farthest = 0;
    for (const Vector3& point : points_of(subdivided(octahedron(), times))) {
      nearest = std::min(nearest, point.norm());
      farthest = std::max(farthest, point.norm());
    }
    return farthest / nearest;
  };
  EXPECT_LT(ratio(1), std::sqrt(2.0f));  // of a corner and the middle of an edge before
  EXPECT_LT(ratio(3), 1.1f);
}

}  // namespace
}  // namespace mercury::render
