// SPDX-License-Identifier: Apache-2.0
#include "render/body_data.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/render/wobbling_bodies.h"

namespace mercury::render {
namespace {

// A unit cube, two triangles per side.
const std::vector<float> cube{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 0, 1, 1, 0, 1, 0, 1, 1, 1, 1, 1};
const std::vector<std::uint32_t> cube_faces{1, 3, 7, 1, 7, 5, 0, 4, 6, 0, 6, 2, 2, 6, 7, 2, 7, 3,
                                            0, 1, 5, 0, 5, 4, 4, 5, 7, 4, 7, 6, 0, 2, 3, 0, 3, 1};

TEST(SkinTopology, SidesOfACubeAreQuadrilaterals) {
  for (const FaceRecord& record : skin_topology(cube, cube_faces)) EXPECT_LT(record.shape, 3u);
}

TEST(SkinTopology, ASideOfACubeHasTheFourAdjacentSidesAsNeighbors) {
  const std::vector<FaceRecord> records = skin_topology(cube, cube_faces);
  for (std::size_t face = 0; face < records.size(); ++face) {
    std::set<std::uint32_t> sides;
    for (const std::uint32_t neighbor : records[face].neighbors) sides.insert(neighbor / 2);
    EXPECT_EQ(sides.size(), 4u);
    const std::uint32_t own = std::uint32_t(face / 2);
    EXPECT_FALSE(sides.contains(own));
    EXPECT_FALSE(sides.contains(own ^ 1u));  // opposite sides are listed in pairs
  }
}

TEST(SkinTopology, NeighborsLieAcrossTheirEdge) {
  const std::vector<FaceRecord> records = skin_topology(cube, cube_faces);
  for (std::size_t face = 0; face < records.size(); ++face) {
    const std::uint32_t corner = records[face].shape;
    // Edge v = 0 runs from the corner opposite to the diagonal to the next one.
    const std::uint32_t a = cube_faces[3 * face + corner], b = cube_faces[3 * face + (corner + 1) % 3];
    const std::size_t other = 3 * std::size_t(records[face].neighbors[2]);
    const std::set<std::uint32_t> masses{cube_faces[other], cube_faces[other + 1], cube_faces[other + 2]};
    EXPECT_TRUE(masses.contains(a) && masses.contains(b));
  }
}

// A search through all equal faces for each of them would take hours.
TEST(SkinTopology, AMillionEqualFacesHaveNoNeighbors) {
  const std::vector<float> corners{0, 0, 0, 1, 0, 0, 0, 1, 0};
  std::vector<std::uint32_t> faces;
  for (int face = 0; face < 1'000'000; ++face) faces.insert(faces.end(), {0, 1, 2});
  const FaceRecord alone = skin_topology(corners, std::vector<std::uint32_t>{0, 1, 2}).front();
  for (const FaceRecord& record : skin_topology(corners, faces)) ASSERT_EQ(record.shape, alone.shape);
}

// Thousands of equal faces on the same pixels took minutes to draw.
TEST(PreparedBody, DrawsOneOfEqualFaces) {
  const std::vector<float> corners{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  const std::vector<std::uint32_t> faces{2, 0, 1, 0, 1, 2, 0, 2, 1, 0, 1, 3, 1, 2, 0, 3, 1, 0};
  const auto body = prepare_body({.rest_positions = corners, .faces = faces});
  // The second and the fifth face are the first, whichever corner is listed first; the third and the sixth face the
  // other way.
  EXPECT_EQ(body->faces, (std::vector<std::uint32_t>{2, 0, 1, 0, 0, 0, 0, 2, 1, 0, 1, 3, 0, 0, 0, 3, 1, 0}));
}

TEST(SkinTopology, ATetrahedronHasOnlyTriangles) {
  const std::vector<float> corners{0, 0, 0, 1, 0, 0, 0.5f, 1, 0, 0.5f, 0.4f, 1};
  const std::vector<FaceRecord> records =
      skin_topology(corners, std::vector<std::uint32_t>{0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3});
  for (std::uint32_t face = 0; face < 4; ++face) {
    EXPECT_EQ(records[face].shape, 3u);
    std::set<std::uint32_t> others(records[face].neighbors.begin(), records[face].neighbors.begin() + 3);
    EXPECT_EQ(others.size(), 3u);
    EXPECT_FALSE(others.contains(face));
  }
}

TEST(SkinTopology, AnOpenBorderHasNoNeighbor) {
  const std::vector<FaceRecord> records =
      skin_topology(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0}, std::vector<std::uint32_t>{0, 1, 2});
  for (int i = 0; i < 3; ++i) EXPECT_EQ(records[0].neighbors[std::size_t(i)], no_face);
}

TEST(SkinTopology, VoxelBodiesAreMadeOfQuadrilaterals) {
  const WobblingBody body = make_wobbling_body(8, 5);
  for (const FaceRecord& record : skin_topology(body.rest, body.faces)) EXPECT_LT(record.shape, 3u);
}

}  // namespace
}  // namespace mercury::render
