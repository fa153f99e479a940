// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "tests/render/triangle.h"

namespace mercury::render {
namespace {

// The distance of a point from a triangle's edges in pixels, positive inside; corners in either order.
float depth_inside(const Vector2& point, const std::array<Vector2, 3>& corners) {
  const auto cross = [](const Vector2& a, const Vector2& b) { return a.x * b.y - a.y * b.x; };
  const float sign = cross(corners[1] - corners[0], corners[2] - corners[0]) > 0 ? 1.0f : -1.0f;
  float inside = 1e9f;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector2 edge = corners[(i + 1) % 3] - corners[i];
    inside = std::min(inside, sign * cross(edge, point - corners[i]) / edge.norm());
  }
  return inside;
}

class PlacementTest : public Offscreen {};

TEST_F(PlacementTest, ATriangleIsDrawnWhereTheCameraProjectsIt) {
  Renderer renderer = make_renderer(200, 150);
  const Image empty = drawn(renderer, plain());
  const Mesh mesh = triangle();
  renderer.set_bodies(std::array{mesh.body()});
  const Image image = drawn(renderer, plain());
  std::array<Vector2, 3> corners;
  for (std::size_t i = 0; i < 3; ++i) corners[i] = pinhole(front(), Vector3(mesh.positions.data() + 3 * i), 200, 150);
  for (int y = 0; y < 150; ++y)
    for (int x = 0; x < 200; ++x) {
      const float inside = depth_inside({float(x) + 0.5f, float(y) + 0.5f}, corners);
      const int change = largest_difference(pixel(image, x, y), pixel(empty, x, y));
      if (inside > 1) {
        ASSERT_GT(change, 20) << x << ", " << y;
      } else if (inside < -1) {
        ASSERT_LE(change, 1) << x << ", " << y;
      }
    }
}

TEST_F(PlacementTest, EdgesAreAntialiased) {
  Renderer renderer = make_renderer();
  const Image empty = drawn(renderer, plain());
  const Mesh mesh = triangle();
  renderer.set_bodies(std::array{mesh.body()});
  const Image image = drawn(renderer, plain());
  const int full = largest_difference(pixel(image, 80, 60), pixel(empty, 80, 60));
  int between = 0;
  for (int y = 0; y < 120; ++y)
    for (int x = 0; x < 160; ++x) {
      const int change = largest_difference(pixel(image, x, y), pixel(empty, x, y));
      between += change > full / 5 && change < full * 4 / 5;
    }
  EXPECT_GT(between, 40);
}

TEST_F(PlacementTest, APlacementMovesABody) {
  Renderer renderer = make_renderer();
  const Mesh mesh = triangle();
  renderer.set_bodies(std::array{mesh.body()});
  Scene scene = plain();
  const std::array placements{Placement{.offset = {0.5f, 0.2f, -0.3f}}};
  scene.placements = placements;
  const Image placed = drawn(renderer, scene);
  std::vector<float> moved = mesh.positions;
  for (std::size_t i = 0; i < moved.size(); i += 3) moved[i] += 0.5f, moved[i + 1] += 0.2f, moved[i + 2] -= 0.3f;
  Scene other = plain();
  other.positions = moved;
  EXPECT_EQ(count_differing(placed, drawn(renderer, other), 2), 0);
}

TEST_F(PlacementTest, TheNearerBodyHidesTheFartherInEitherOrder) {
  Renderer renderer = make_renderer();
  const Mesh near = triangle(-0.5f), far = triangle(0.5f);
  const std::array<std::uint32_t, 1> first{0}, second{1};
  const std::array materials{RenderMaterial{rgb(0xd01010)}, RenderMaterial{rgb(0x1010d0)}};
  Scene scene = plain();
  scene.materials = materials;
  Body a = near.body(), b = far.body();
  a.face_materials = first;
  b.face_materials = second;
  renderer.set_bodies(std::array{a, b});
  const Rgb near_color = pixel(drawn(renderer, scene), 80, 60);
  renderer.set_bodies(std::array{b, a});
  EXPECT_LE(largest_difference(pixel(drawn(renderer, scene), 80, 60), near_color), 1);
  EXPECT_GT(near_color.x, near_color.z + 80);
}

TEST_F(PlacementTest, AHiddenBodyIsNotDrawn) {
  Renderer renderer = make_renderer();
  Scene scene = plain();
  scene.surroundings = Surroundings::land;
  scene.floor = -1;
  const Image empty = drawn(renderer, scene);
  const Mesh mesh = triangle();
  renderer.set_bodies(std::array{mesh.body()});
  const std::array placements{Placement{.hidden = true}};
  scene.placements = placements;
  scene.show = {true, true, true};
  EXPECT_EQ(count_differing(drawn(renderer, scene), empty, 1), 0);
}

}  // namespace
}  // namespace mercury::render
