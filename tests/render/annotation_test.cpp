// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "tests/render/triangle.h"

namespace mercury::render {
namespace {

class AnnotationTest : public Offscreen {};

TEST_F(AnnotationTest, ArrowsAndPathsAreDrawnAtTheirProjectedPositions) {
  Renderer renderer = make_renderer();
  const Mesh mesh = triangle();
  renderer.set_bodies(std::array{mesh.body()});
  Scene scene = plain();
  scene.show.skin = false;
  const Image empty = drawn(renderer, scene);
  const std::array arrows{Arrow{0, {-1, 0, 0}, {1.5f, 0, 0}, rgb(0xff8000)}};
  scene.arrows = arrows;
  const Image arrow = drawn(renderer, scene);
  const Vector2 on = pinhole(front(), {-0.3f, 0, 0}, 160, 120), off = pinhole(front(), {0.7f, 0, 0}, 160, 120);
  EXPECT_GT(largest_difference(pixel(arrow, int(on.x), int(on.y)), pixel(empty, int(on.x), int(on.y))), 60);
  EXPECT_LE(largest_difference(pixel(arrow, int(off.x), int(off.y)), pixel(empty, int(off.x), int(off.y))), 1);
  const std::array<float, 6> points{-1, 0, 0.5f, 1, 0, 0.5f};
  const std::array paths{Path{0, points, rgb(0x40ff40)}};
  scene.arrows = {};
  scene.paths = paths;
  const Image path = drawn(renderer, scene);
  int changed = 0;
  const Vector2 end = pinhole(front(), {0.95f, 0, 0.5f}, 160, 120);
  for (int dy = -2; dy <= 2; ++dy)
    changed +=
        largest_difference(pixel(path, int(end.x), int(end.y) + dy), pixel(empty, int(end.x), int(end.y) + dy)) > 20;
  EXPECT_GT(changed, 0);
}

TEST_F(AnnotationTest, TilesHaveTheirColorsBehindBodies) {
  Renderer renderer = make_renderer(640, 480);
  const Mesh mesh = triangle();
  renderer.set_bodies(std::array{mesh.body()});
  Scene scene = plain();
  const Image without = drawn(renderer, scene);
  // Nearer to the eye than the triangle.
  const std::array tiles{Tile{{0, -0.2f, 0}, {1.2f, 0, 0}, {0, 0, 0.7f}, rgb(0x30508c), rgb(0x21918c)}};
  scene.tiles = tiles;
  const Image with = drawn(renderer, scene);
  const auto at = [](const Image& image, const Vector3& point) {
    const Vector2 p = pinhole(front(), point, 640, 480);
    return pixel(image, int(p.x), int(p.y));
  };
  const Rgb fill = at(with, {0.8f, -0.2f, 0.5f});
  EXPECT_LE(largest_difference(fill, {0x30, 0x50, 0x8c}), 3);
  EXPECT_LE(largest_difference(at(with, {1.18f, -0.2f, 0.2f}), {0x21, 0x91, 0x8c}), 3);  // the frame
  EXPECT_LE(largest_difference(at(with, {0.1f, 0, 0}), at(without, {0.1f, 0, 0})), 40);  // the triangle
  EXPECT_GT(largest_difference(at(with, {0.1f, 0, 0}), fill), 60);
}

}  // namespace
}  // namespace mercury::render
