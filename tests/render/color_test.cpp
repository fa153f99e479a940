// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "tests/render/triangle.h"

namespace mercury::render {
namespace {

class ColorTest : public Offscreen {};

TEST_F(ColorTest, APlacementSelectsMaterialsWithoutNewBodies) {
  Renderer renderer = make_renderer();
  const Mesh mesh = triangle();
  const std::array<std::uint32_t, 1> face_material{1};
  const std::array<std::uint32_t, 3> spring_materials{1, 1, 1};
  Body body = mesh.body();
  body.face_materials = face_material;
  body.spring_materials = spring_materials;
  // Prepared beforehand, as on another thread.
  const std::array prepared{prepare_body(body)};
  renderer.set_bodies(assemble(prepared));
  EXPECT_EQ(renderer.spring_count(), 3u);
  const std::array materials{RenderMaterial{rgb(0x101010)}, RenderMaterial{rgb(0xd01010)},
                             RenderMaterial{rgb(0x101010)}, RenderMaterial{rgb(0x1010d0)}};
  for (const bool springs : {false, true}) {
    Scene scene = plain();
    scene.show = {.skin = !springs, .springs = springs};
    scene.spring_radius = 0.1f;
    scene.materials = materials;
    const Vector2 middle = pinhole(front(), {0.05f, 0, -0.45f}, 160, 120);  // of the first spring
    const auto color = [&](std::uint32_t first_material) {
      const std::array placements{Placement{.selected = false, .first_material = first_material}};
      scene.placements = placements;
      return springs ? pixel(drawn(renderer, scene), int(middle.x), int(middle.y))
                     : pixel(drawn(renderer, scene), 80, 60);
    };
    const Rgb red = color(0), blue = color(2);
    EXPECT_GT(red.x, red.z + 80) << springs;
    EXPECT_GT(blue.z, blue.x + 80) << springs;
  }
}

TEST_F(ColorTest, AContractedMuscleIsBrighterThanAStretchedOne) {
  Renderer renderer = make_renderer();
  const Mesh mesh = triangle();
  renderer.set_bodies(std::array{mesh.body()});
  int last = -1;
  for (const float activation : {-1.0f, 0.0f, 0.6f, 1.0f}) {
    const std::array materials{RenderMaterial{muscle_color(0, 0.5f), activation}};
    Scene scene = plain();
    scene.materials = materials;
    const int brightness = pixel(drawn(renderer, scene), 80, 60).sum();
    EXPECT_GT(brightness, last + 10) << activation;
    last = brightness;
  }
}

TEST_F(ColorTest, ValuesColorSkinsSpringsAndMassesByTheScale) {
  Renderer renderer = make_renderer();
  const Mesh mesh = triangle();
  renderer.set_bodies(std::array{mesh.body()});
  const std::array<float, 1> low_face{0}, high_face{1};
  const std::array<float, 3> low{0, 0, 0}, high{1, 1, 1};
  const auto check = [&](Scene scene, auto set) {
    scene.scale = {0, 1, Colormap::diverging};
    set(scene, false);
    const Image cold = drawn(renderer, scene);
    set(scene, true);
    const Image warm = drawn(renderer, scene);
    int redder = 0, bluer = 0;
    for (int y = 0; y < 120; ++y)
      for (int x = 0; x < 160; ++x) {
        if (largest_difference(pixel(cold, x, y), pixel(warm, x, y)) < 10) continue;
        redder += pixel(warm, x, y).x > pixel(warm, x, y).z;
        bluer += pixel(cold, x, y).z > pixel(cold, x, y).x;
      }
    EXPECT_GT(redder, 50);
    EXPECT_GT(bluer, 50);
  };
  check(plain(), [&](Scene& s, bool warm) { s.face_values = warm ? high_face : low_face; });
  check(plain(), [&](Scene& s, bool warm) { s.mass_values = warm ? high : low; });
  Scene springs = plain();
  springs.show = {false, true, false};
  springs.spring_radius = 0.05f;
  check(springs, [&](Scene& s, bool warm) { s.spring_values = warm ? high : low; });
  Scene masses = plain();
  masses.show = {false, false, true};
  masses.mass_radius = 0.1f;
  check(masses, [&](Scene& s, bool warm) { s.mass_values = warm ? high : low; });
}

TEST_F(ColorTest, LegendHasTheColorsOfItsValues) {
  Renderer renderer = make_renderer(320, 240);
  for (int map = 0; map < colormap_count; ++map) {
    Scene scene = plain();
    const Image without = drawn(renderer, scene);
    scene.legend = Legend{"speed", "m/s", Scale{0, 1, Colormap(map)}, {}};
    const Image image = drawn(renderer, scene);
    // Finds the bar by its colors: a column that contains both the high end's and the low end's.
    const auto close = [&](int x, int y, float t) {
      const Color c = color_at(Colormap(map), t);
      return largest_difference(pixel(image, x, y), {c.r, c.g, c.b}) <= 6;
    };
    int column = -1, top = 0, bottom = 0;
    for (int x = 319; x > 160 && column < 0; --x)
      for (int high = 0; high < 240 && column < 0; ++high)
        if (close(x, high, 0.994f))
          for (int low = 239; low > high + 60; --low)
            if (close(x, low, 0.006f)) {
              column = x - 3, top = high, bottom = low;
              break;
            }
    ASSERT_GE(column, 0) << name_of(Colormap(map));
    for (int y = top; y <= bottom; ++y) {
      const float t = 1 - (float(y - top) + 0.5f) / float(bottom - top + 1);
      const Color expected = color_at(Colormap(map), t);
      EXPECT_LE(largest_difference(pixel(image, column, y), {expected.r, expected.g, expected.b}), 12) << y;
    }
    EXPECT_EQ(largest_difference(pixel(image, 20, 20), pixel(without, 20, 20)), 0);
  }
}

}  // namespace
}  // namespace mercury::render
