// SPDX-License-Identifier: Apache-2.0
#include "render/passes/print_pass.h"

#include <cmath>

#include "tests/render/offscreen.h"

namespace mercury::render {
namespace {

class PrintTest : public Offscreen {
 protected:
  Image drawn(Quality quality, std::span<const Print> prints, std::span<const Patch> patches = {}) {
    Renderer renderer(*context_, {.width = 160, .height = 120, .quality = quality});
    Scene scene;
    scene.surroundings = Surroundings::land;
    scene.prints = prints;
    scene.patches = patches;
    renderer.draw(scene, camera_);
    return read(renderer);
  }
  // How far a pixel of a picture is from the middle, on the ground [m]: the eye looks down from 3 m at 0.6 rad.
  static double meters(int x, int y) { return std::hypot(x - 79.5, y - 59.5) * 2 * 3 * std::tan(0.3) / 120; }

  const Camera camera_ = Orbit{.elevation = 1.5f, .distance = 3}.camera();
  const std::vector<Print> two_{{.corners = {Vector2{-0.1f, -0.1f}, {0.1f, -0.1f}, {0, 0.1f}}, .radius = 0.05f},
                                {.corners = {Vector2{0, 0}, {0.15f, 0.05f}, {0.15f, 0.05f}}, .radius = 0.05f}};
};

TEST_F(PrintTest, APrintShowsWhereItIsAndNowhereElse) {
  const Image bare = drawn(Quality::medium, {}), printed = drawn(Quality::medium, two_);
  int inside = 0, outside = 0;
  for (int y = 0; y < 120; ++y)
    for (int x = 0; x < 160; ++x) {
      const bool differs = largest_difference(pixel(bare, x, y), pixel(printed, x, y)) > 3;
      inside += meters(x, y) < 0.25 && differs;
      outside += meters(x, y) > 0.40 && differs;
    }
  EXPECT_GT(inside, 100);
  EXPECT_EQ(outside, 0);
}

TEST_F(PrintTest, TheOrderOfPrintsDoesNotMatter) {
  const std::vector<Print> turned(two_.rbegin(), two_.rend());
  EXPECT_EQ(drawn(Quality::medium, two_).bytes, drawn(Quality::medium, turned).bytes);
}

TEST_F(PrintTest, APrintThatIsGoneLeavesNothing) {
  std::vector<Print> gone = two_;
  for (Print& print : gone) print.depth = 0;
  EXPECT_EQ(count_differing(drawn(Quality::medium, gone), drawn(Quality::medium, {}), 1), 0);
}

TEST_F(PrintTest, LowQualityHasNone) { EXPECT_EQ(drawn(Quality::low, two_).bytes, drawn(Quality::low, {}).bytes); }

TEST_F(PrintTest, WherePatchesAreOnlyTheyHavePrints) {
  Patch patch{.center = {5, 5}, .radius = 0.2f};
  const std::span<const Patch> far(&patch, 1);
  EXPECT_EQ(count_differing(drawn(Quality::medium, two_, far), drawn(Quality::medium, {}, far), 0), 0);
  patch.center = {0, 0};
  EXPECT_GT(count_differing(drawn(Quality::medium, two_, far), drawn(Quality::medium, {}, far), 3), 50);
}

TEST(PrintMap, LiesOnAGridThatDoesNotMoveWithTheCamera) {
  const std::vector<Print> prints{{.corners = {Vector2{3, 4}, {3, 4}, {3, 4}}, .radius = 0.03f}};
  for (int i = 0; i < 50; ++i) {
    const float along = 3 + 0.0137f * static_cast<float>(i);
    const PrintMap map = print_map(prints, Orbit{.target = {along, 4, 0}, .distance = 4}.camera(), 1024);
    for (const float corner : {map.corner.x, map.corner.y})
      EXPECT_EQ(corner, 8 * map.texel * std::round(corner / (8 * map.texel)));
    EXPECT_LE(map.texel, 0.2f * 0.03f) << "fine enough for the print's walls";
    EXPECT_LT(map.corner.x, 3 - 0.5f);
    EXPECT_GT(map.corner.x + 1024 * map.texel, 3 + 0.5f);
  }
}

TEST(PrintMap, ReachesPrintsThatAreInViewAndNotThoseFarAway) {
  std::vector<Print> prints{{.corners = {Vector2{6, 0}, {6, 0}, {6, 0}}, .radius = 0.03f}};
  const Camera camera = Orbit{.distance = 4}.camera();
  EXPECT_GT(print_map(prints, camera, 1024).corner.x + 1024 * print_map(prints, camera, 1024).texel, 6.1f);
  prints.push_back({.corners = {Vector2{6000, 0}, {6000, 0}, {6000, 0}}, .radius = 0.03f});
  EXPECT_LT(1024 * print_map(prints, camera, 1024).texel, 50);
}

}  // namespace
}  // namespace mercury::render
