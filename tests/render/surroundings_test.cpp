// SPDX-License-Identifier: Apache-2.0
#include "tests/render/offscreen.h"
#include "tests/render/triangle.h"
#include "tests/render/wobbling_bodies.h"

namespace mercury::render {
namespace {

class SurroundingsTest : public Offscreen {};

TEST_F(SurroundingsTest, ABodyOnTheGroundCastsAShadow) {
  Renderer renderer = make_renderer();
  const WobblingGroup group = make_wobbling_group(1, 6, 3, 1);
  Scene scene;
  scene.surroundings = Surroundings::land;
  scene.floor = -0.5f;
  Orbit orbit{.elevation = 1.2f, .distance = 4};
  const Image empty = drawn(renderer, scene, orbit.camera());
  renderer.set_bodies(group.views());
  const Image image = drawn(renderer, scene, orbit.camera());
  int darker = 0;
  for (int y = 0; y < 120; ++y)
    for (int x = 0; x < 160; ++x) darker += pixel(image, x, y).sum() < pixel(empty, x, y).sum() - 40;
  EXPECT_GT(darker, 150);
  EXPECT_LE(largest_difference(pixel(image, 2, 2), pixel(empty, 2, 2)), 1);
}

TEST_F(SurroundingsTest, ParticlesDriftWithTheFlow) {
  Renderer renderer = make_renderer();
  Scene scene;
  scene.floor = -100;
  const Image still = drawn(renderer, scene);
  scene.flow = {2, 0, 0};
  EXPECT_GT(count_differing(still, drawn(renderer, scene), 3), 10);
}

}  // namespace
}  // namespace mercury::render
