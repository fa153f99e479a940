// SPDX-License-Identifier: Apache-2.0
#include <cmath>

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
  for (const bool as_springs : {false, true}) {
    scene.show.skin = !as_springs;
    scene.show.springs = as_springs;
    const Image image = drawn(renderer, scene, orbit.camera());
    int darker = 0;
    for (int y = 0; y < 120; ++y)
      for (int x = 0; x < 160; ++x) darker += pixel(image, x, y).sum() < pixel(empty, x, y).sum() - 40;
    EXPECT_GT(darker, 150) << as_springs;
    EXPECT_LE(largest_difference(pixel(image, 2, 2), pixel(empty, 2, 2)), 1);
  }
}

TEST_F(SurroundingsTest, ParticlesDriftWithTheFlow) {
  Renderer renderer = make_renderer();
  Scene scene;
  scene.floor = -100;
  const Image still = drawn(renderer, scene);
  scene.flow = {2, 0, 0};
  EXPECT_GT(count_differing(still, drawn(renderer, scene), 3), 10);
}

TEST_F(SurroundingsTest, OnlyTheGroundOfAPatchSlides) {
  Renderer renderer = make_renderer();
  Scene scene;
  scene.surroundings = Surroundings::land;
  const Camera camera = Orbit{.elevation = 1.5f, .distance = 6}.camera();
  Patch patch{.center = {0, 0}, .radius = 0.8f};
  scene.patches = {&patch, 1};
  const Image before = drawn(renderer, scene, camera);
  patch.slide = {0.37f, 0.21f};
  const Image after = drawn(renderer, scene, camera);
  int inside = 0, outside = 0;
  for (int y = 0; y < 120; ++y)
    for (int x = 0; x < 160; ++x) {
      // The eye looks down from 6 m at 0.6 rad for 120 pixels.
      const double meters = std::hypot(x - 79.5, y - 59.5) * 2 * 6 * std::tan(0.3) / 120;
      const bool differs = largest_difference(pixel(before, x, y), pixel(after, x, y)) > 3;
      inside += meters < 0.7 && differs;
      outside += meters > 0.9 && differs;
    }
  EXPECT_GT(inside, 300);
  EXPECT_EQ(outside, 0);
}

// They are two parts of a picture.
TEST_F(SurroundingsTest, NothingOfAnEarlierPictureShowsWhereTheFloorEnds) {
  Renderer renderer = make_renderer();
  Scene black, white;
  black.surroundings = white.surroundings = Surroundings::none;
  black.flat_backdrop = 0;
  white.flat_backdrop = 1;
  for (const Surroundings around : {Surroundings::water, Surroundings::land})
    for (int i = -4; i <= 4; ++i) {
      Scene scene;
      scene.surroundings = around;
      const Camera camera =
          Orbit{.target = {0, 0, 1}, .azimuth = 0.3f * float(i), .elevation = 0.11f * float(i)}.camera();
      drawn(renderer, black);
      const Image after_black = drawn(renderer, scene, camera);
      drawn(renderer, white);
      EXPECT_EQ(count_differing(after_black, drawn(renderer, scene, camera), 0), 0) << "elevation " << 0.11 * i;
    }
}

TEST_F(SurroundingsTest, HazeJoinsGroundAndSkyAtTheHorizon) {
  Renderer renderer = make_renderer();
  for (const Theme theme : {Theme::dark, Theme::light}) {
    Scene scene;
    scene.surroundings = Surroundings::land;
    scene.theme = theme;
    const Image image = drawn(renderer, scene, Orbit{.target = {0, 0, 1}, .elevation = 0.02f, .distance = 6}.camera());
    // Neighboring rows differ little anywhere: there is no edge of the world.
    for (int y = 1; y < 120; ++y) {
      Rgb above, below;
      for (int x = 0; x < 160; ++x) {
        above += pixel(image, x, y - 1);
        below += pixel(image, x, y);
      }
      EXPECT_LT(largest_difference(above, below) / 160, 24) << "row " << y;
    }
    const Rgb sky = pixel(image, 80, 2), haze = pixel(image, 80, 52);
    EXPECT_GT(largest_difference(sky, haze), 8) << "the sky is darker or bluer high up";
  }
}

}  // namespace
}  // namespace mercury::render
