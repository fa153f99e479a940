// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstdint>
#include <vector>

#include "tests/render/triangle.h"

namespace mercury::render {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3i;

class CutTest : public Offscreen {};

TEST_F(CutTest, ACutRemovesTheSideItsNormalPointsTo) {
  Renderer renderer = make_renderer();
  const Image empty = drawn(renderer, plain());
  const Mesh mesh = triangle();
  renderer.set_bodies(std::array{mesh.body()});
  const Image whole = drawn(renderer, plain());
  Scene scene = plain();
  scene.cut = CutPlane{{0, 0, 1}, 0};
  const Image cut = drawn(renderer, scene);
  const Vector2f above = pinhole(front(), {0.1f, 0, 0.3f}, 160, 120), below = pinhole(front(), {0, 0, -0.3f}, 160, 120);
  EXPECT_LE(
      largest_difference(pixel(cut, int(above.x()), int(above.y())), pixel(empty, int(above.x()), int(above.y()))), 1);
  EXPECT_LE(
      largest_difference(pixel(cut, int(below.x()), int(below.y())), pixel(whole, int(below.x()), int(below.y()))), 6);
}

// A cube of side 1 about the origin: faces of material 0; springs of material 1 along its edges and through its middle.
struct Cube {
  std::vector<float> positions;
  std::vector<std::uint32_t> faces{0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                   2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
  std::vector<std::uint32_t> springs, spring_materials;
  Cube() {
    for (std::uint32_t i = 0; i < 8; ++i)
      for (const std::uint32_t bit : {1u, 2u, 4u}) positions.push_back(i & bit ? 0.5f : -0.5f);
    for (std::uint32_t a = 0; a < 8; ++a)
      for (std::uint32_t b = a + 1; b < 8; ++b) springs.insert(springs.end(), {a, b});
    spring_materials.assign(springs.size() / 2, 1);
  }
  Body body() const { return {positions, faces, springs, {}, spring_materials}; }
};

TEST_F(CutTest, ACutShowsSolidBodiesInTheMaterialsOfTheirSprings) {
  Renderer renderer = make_renderer();
  const Cube cube;
  renderer.set_bodies(std::array{cube.body()});
  Scene scene = plain();
  const std::array materials{RenderMaterial{.color = {200, 40, 40}}, RenderMaterial{.color = {40, 200, 40}}};
  scene.materials = materials;
  const auto is_green = [](const Vector3i& color) { return 2 * color.y() > 3 * color.x(); };
  const auto is_red = [](const Vector3i& color) { return 2 * color.x() > 3 * color.y(); };
  const Image whole = drawn(renderer, scene);
  scene.cut = CutPlane{{0, -1, 0}, 0};  // its near half is gone
  const Image cut = drawn(renderer, scene);
  // The square where the plane cuts the cube, without its rim.
  for (const float x : {-0.44f, -0.2f, 0.0f, 0.2f, 0.44f})
    for (const float z : {-0.44f, -0.2f, 0.0f, 0.2f, 0.44f}) {
      const Vector2f at = pinhole(front(), {x, 0, z}, 160, 120);
      EXPECT_TRUE(is_red(pixel(whole, int(at.x()), int(at.y())))) << x << " " << z;
      EXPECT_TRUE(is_green(pixel(cut, int(at.x()), int(at.y())))) << x << " " << z;
    }
  // From behind, the cut is not visible.
  const Camera behind{.eye = {0.2f, 4, 0.1f}};
  const Vector2f middle = pinhole(behind, {0, 0.5f, 0}, 160, 120);
  EXPECT_TRUE(is_red(pixel(drawn(renderer, scene, behind), int(middle.x()), int(middle.y()))));
  // With springs shown, bodies are hollow: between the springs, the far wall is visible.
  scene.show.springs = true;
  scene.spring_radius = 0.005f;
  const Vector2f between = pinhole(front(), {0.13f, 0.5f, 0.33f}, 160, 120);
  EXPECT_TRUE(is_red(pixel(drawn(renderer, scene), int(between.x()), int(between.y()))));
}

}  // namespace
}  // namespace mercury::render
