// SPDX-License-Identifier: Apache-2.0
// Soft shadows on skins and on tiles.
#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "tests/render/offscreen.h"
#include "tests/render/triangle.h"

namespace mercury::render {
namespace {

// A flat box around the origin.
struct Plate {
  std::vector<float> corners;
  std::vector<std::uint32_t> faces{0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                   2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
  Plate(float half_width, float half_height) {
    for (const float z : {-half_height, half_height})
      for (const float y : {-half_width, half_width})
        for (const float x : {-half_width, half_width}) corners.insert(corners.end(), {x, y, z});
  }
  Body body() const { return {.rest_positions = corners, .faces = faces}; }
};

// Pixels right of the middle that differ from all four neighbors in the same direction by more than `steps` of a
// channel's sum.
int count_speckles(const Image& image, int steps) {
  int count = 0;
  for (int y = 30; y + 30 < image.height; ++y)
    for (int x = image.width / 2; x + 1 < image.width; ++x) {
      const int own = pixel(image, x, y).sum();
      int lowest = 1000, highest = 0;
      for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
        const int other = pixel(image, x + dx, y + dy).sum();
        lowest = std::min(lowest, other);
        highest = std::max(highest, other);
      }
      count += own > highest + steps || own < lowest - steps;
    }
  return count;
}

class SoftShadow : public Offscreen {
 protected:
  // The last placement throws the shadow. There are fewer than `most` speckles.
  void expect_smooth(std::span<const Body> bodies, Scene scene, std::span<Placement> placements, int most) {
    const Camera camera = Orbit{.elevation = 1.4f, .distance = 2.2f}.camera();
    scene.placements = placements;
    for (const Quality quality : {Quality::medium, Quality::high}) {
      Renderer renderer(*context_, {.width = 320, .height = 240, .quality = quality});
      renderer.set_bodies(bodies);
      const Image with = drawn(renderer, scene, camera);
      placements.back().hidden = true;
      const Image without = drawn(renderer, scene, camera);
      placements.back().hidden = false;
      EXPECT_GT(count_differing(with, without, 20), 3000) << "the shadow";
      EXPECT_LT(count_speckles(with, 6), most) << name_of(quality);
    }
  }
};

TEST_F(SoftShadow, OnASkinIsSmooth) {
  const Plate below(1, 0.1f), above(0.3f, 0.05f);
  const std::array bodies{below.body(), above.body()};
  std::vector<float> positions = below.corners;
  positions.insert(positions.end(), above.corners.begin(), above.corners.end());
  std::array<Placement, 2> placements;
  placements[1].offset = {-0.35f, -0.2f, 1.2f};  // toward the light, at the left in the picture
  Scene scene;
  scene.surroundings = Surroundings::none;
  scene.positions = positions;
  expect_smooth(bodies, scene, placements, 10);
}

TEST_F(SoftShadow, OnATileIsSmooth) {
  const Plate above(0.3f, 0.05f);
  const std::array bodies{above.body()};
  const Tile tile{.half_width = {1, 0, 0}, .half_height = {0, 1, 0}, .fill = rgb(0xcccccc), .frame = rgb(0x808080)};
  std::array<Placement, 1> placements;
  placements[0].offset = {-0.35f, -0.2f, 1.2f};
  Scene scene;
  scene.surroundings = Surroundings::none;
  scene.positions = above.corners;
  scene.tiles = {&tile, 1};
  expect_smooth(bodies, scene, placements, 100);  // 2,105 and 433 with a pattern per pixel
}

}  // namespace
}  // namespace mercury::render
