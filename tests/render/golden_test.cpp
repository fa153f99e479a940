// SPDX-License-Identifier: Apache-2.0
// Whole pictures, compared with reference pictures that people have checked. After an intended change, write the
// references again with MERCURY_WRITE_GOLDEN=1, and look at them before you commit them.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

#include "render/colormap.h"
#include "render/png.h"
#include "tests/render/offscreen.h"
#include "tests/render/wobbling_bodies.h"

namespace mercury::render {
namespace {

constexpr int golden_width = 192, golden_height = 108;

// Lightness and two opponent colors (CIE 1976 L*a*b*, D65) of the mean light over a square of pixels.
Vector3 perceived(const Image& image, int x, int y, int side) {
  Vector3 sum(0, 0, 0);
  for (int dy = 0; dy < side; ++dy)
    for (int dx = 0; dx < side; ++dx) {
      const Rgb p = pixel(image, x + dx, y + dy);
      const auto light = linear_of({std::uint8_t(p.x), std::uint8_t(p.y), std::uint8_t(p.z), 255});
      sum += Vector3(light[0], light[1], light[2]);
    }
  sum *= 1 / float(side * side);
  const auto f = [](float t) { return t > 0.008856f ? std::cbrt(t) : 7.787f * t + 16.0f / 116; };
  const float fx = f((0.4124f * sum.x + 0.3576f * sum.y + 0.1805f * sum.z) / 0.9505f);
  const float fy = f(0.2126f * sum.x + 0.7152f * sum.y + 0.0722f * sum.z);
  const float fz = f((0.0193f * sum.x + 0.1192f * sum.y + 0.9505f * sum.z) / 1.089f);
  return {116 * fy - 16, 500 * (fx - fy), 200 * (fy - fz)};
}

struct Difference {
  float mean = 0, largest = 0;  // over squares of 4 pixels, in units of L*a*b*; about 2 is just visible
};

Difference difference(const Image& a, const Image& b) {
  constexpr int side = 4;
  Difference result;
  for (int y = 0; y + side <= golden_height; y += side)
    for (int x = 0; x + side <= golden_width; x += side) {
      const float d = (perceived(a, x, y, side) - perceived(b, x, y, side)).norm();
      result.mean += d * float(side * side) / float(golden_width * golden_height);
      result.largest = std::max(result.largest, d);
    }
  return result;
}

struct Case {
  const char* name;
  Surroundings surroundings;
  Theme theme;
  Show show;
};

class GoldenTest : public Offscreen, public testing::WithParamInterface<Case> {};

TEST_P(GoldenTest, PictureMatchesItsReference) {
  const Case& c = GetParam();
  Renderer renderer = make_renderer(golden_width, golden_height);
  const WobblingGroup group = make_wobbling_group(6, 6, 4, 0.9f);
  renderer.set_bodies(group.views());
  const std::vector<float> positions = group.positions(1.7);
  const std::vector<RenderMaterial> materials = wobbling_materials(1.7);
  Scene scene;
  scene.positions = positions;
  scene.materials = materials;
  scene.placements = group.placements;
  scene.surroundings = c.surroundings;
  scene.theme = c.theme;
  scene.show = c.show;
  scene.floor = -0.45f;
  if (c.show.skin) scene.ground_cover = GroundCover{.height = 0.3f};
  scene.time = 1.7;
  std::vector<Bounds> boxes;
  for (std::size_t i = 0; i < group.bodies.size(); ++i)
    boxes.push_back(bounds_of(group.bodies[i].rest).moved(group.placements[i].offset));
  Orbit orbit{.azimuth = -1.2f, .elevation = 0.6f};
  orbit.frame(boxes, float(golden_width) / float(golden_height), 1.1f);
  renderer.draw(scene, orbit.camera());
  const Image image = read(renderer);
  const std::string path = std::string(MERCURY_GOLDEN_FOLDER) + "/" + c.name + ".png";
  if (std::getenv("MERCURY_WRITE_GOLDEN")) write_png(path, image);
  const Difference found = difference(image, read_png(path));
  EXPECT_LT(found.mean, 1.0f);
  EXPECT_LT(found.largest, 15.0f);
}

INSTANTIATE_TEST_SUITE_P(Scenes, GoldenTest,
                         testing::Values(Case{"water_dark", Surroundings::water, Theme::dark, {true, false, false}},
                                         Case{"land_light", Surroundings::land, Theme::light, {true, false, false}},
                                         Case{"lattice", Surroundings::land, Theme::dark, {false, true, true}}),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace mercury::render
