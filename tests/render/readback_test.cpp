// SPDX-License-Identifier: Apache-2.0
#include "render/readback.h"

#include <epoxy/gl.h>

#include <algorithm>

#include "render/context/gl_objects.h"
#include "tests/render/offscreen.h"
#include "tests/render/wobbling_bodies.h"

namespace mercury::render {
namespace {

class ReadbackTest : public Offscreen {
 protected:
  // A picture of many colors, different in every frame.
  void draw(Renderer& renderer, double time) {
    if (renderer.body_count() == 0) renderer.set_bodies(group_.views());
    const std::vector<RenderMaterial> materials = wobbling_materials(time);
    const std::vector<float> positions = group_.positions(time);
    Scene scene;
    scene.materials = materials;
    scene.positions = positions;
    scene.placements = group_.placements;
    scene.floor = -0.6f;
    Orbit orbit{.distance = 3};
    renderer.draw(scene, orbit.camera());
  }
  WobblingGroup group_ = make_wobbling_group(4, 5, 3, 0.8f);
};

TEST_F(ReadbackTest, RgbaIsRgbWithOpaqueAlpha) {
  Renderer renderer = make_renderer(61, 43);  // odd, so that rows do not start at whole words
  draw(renderer, 1);
  const Image rgb = read(renderer), rgba = read(renderer, PixelFormat::rgba);
  ASSERT_EQ(rgb.bytes.size(), 3u * 61 * 43);
  ASSERT_EQ(rgba.bytes.size(), 4u * 61 * 43);
  for (std::size_t i = 0; i < 61 * 43; ++i) {
    for (std::size_t c = 0; c < 3; ++c) ASSERT_EQ(rgb.bytes[3 * i + c], rgba.bytes[4 * i + c]);
    ASSERT_EQ(rgba.bytes[4 * i + 3], 255);
  }
}

// Asks for a texture as large as the limits of the device allow, which no device can hold: 8 TiB where a side may be
// 16,384.
void use_more_memory_than_there_is() {
  GLint side = 0, layers = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &side);
  glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &layers);
  GLuint name = 0;
  glCreateTextures(GL_TEXTURE_2D_ARRAY, 1, &name);
  const Texture texture(name);
  glTextureStorage3D(name, 1, GL_RGBA32F, side, side, layers);
}

// A GPU without room draws nothing and only sets a flag: the picture would be black.
TEST_F(ReadbackTest, PicturesDrawnWithoutMemoryAreRefused) {
  Renderer renderer = make_renderer();
  draw(renderer, 1);
  const Image good = read(renderer);
  use_more_memory_than_there_is();
  // NVIDIA's driver takes memory only when something is written, and then for minutes.
  if (glGetError() != GL_OUT_OF_MEMORY) GTEST_SKIP() << "this driver promises more memory than there is";
  context_->take_messages();
  use_more_memory_than_there_is();
  EXPECT_THAT([&] { (void)read(renderer); },
              testing::ThrowsMessage<ContextError>(testing::HasSubstr("no memory left to draw with")));
  context_->take_messages();
  EXPECT_EQ(read(renderer).bytes, good.bytes) << "the failure is reported once";
}

TEST_F(ReadbackTest, UpperRowComesFirst) {
  Renderer renderer = make_renderer();
  const std::vector<float> high{-0.5f, 0, 0.5f, 0.5f, 0, 0.5f, 0, 0, 0.9f};
  const std::vector<std::uint32_t> faces{0, 1, 2};
  Scene scene;
  scene.surroundings = Surroundings::none;
  const Camera camera{.eye = {0, -4, 0}, .target = {0, 0, 0}};
  renderer.draw(scene, camera);
  const Image empty = read(renderer);
  renderer.set_bodies(std::array{Body{high, faces, {}, {}, {}}});
  renderer.draw(scene, camera);
  const Image image = read(renderer);
  int upper = 0, lower = 0;
  for (int y = 0; y < 120; ++y)
    for (int x = 0; x < 160; ++x)
      (y < 60 ? upper : lower) += largest_difference(pixel(image, x, y), pixel(empty, x, y)) > 10;
  EXPECT_GT(upper, 100);
  EXPECT_EQ(lower, 0);
}

// BT.709, limited range, from the standard's formulas.
TEST_F(ReadbackTest, PlanesFollowTheStandard) {
  const int width = 64, height = 48;
  Renderer renderer = make_renderer(width, height);
  draw(renderer, 1);
  const Image rgb = read(renderer), yuv = read(renderer, PixelFormat::yuv420);
  ASSERT_EQ(yuv.bytes.size(), std::size_t(width * height * 3 / 2));
  const auto channel = [&](int x, int y, int c) {
    const Rgb color = pixel(rgb, std::clamp(x, 0, width - 1), y);
    return double(c == 0 ? color.x : c == 1 ? color.y : color.z) / 255;
  };
  const auto luma = [&](int x, int y) {
    return 0.2126 * channel(x, y, 0) + 0.7152 * channel(x, y, 1) + 0.0722 * channel(x, y, 2);
  };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) ASSERT_NEAR(yuv.bytes[std::size_t(y * width + x)], 16 + 219 * luma(x, y), 1.01);
  for (int j = 0; j < height / 2; ++j)
    for (int i = 0; i < width / 2; ++i) {
      double blue = 0, red = 0;
      for (int row = 0; row < 2; ++row)
        for (int tap = -1; tap <= 1; ++tap) {
          const int x = std::clamp(2 * i + tap, 0, width - 1), y = 2 * j + row;
          const double weight = (tap == 0 ? 0.5 : 0.25) / 2;
          blue += weight * (channel(x, y, 2) - luma(x, y)) / 1.8556;
          red += weight * (channel(x, y, 0) - luma(x, y)) / 1.5748;
        }
      const std::size_t at = std::size_t(width * height + j * (width / 2) + i);
      ASSERT_NEAR(yuv.bytes[at], 128 + 224 * blue, 1.01);
      ASSERT_NEAR(yuv.bytes[at + std::size_t(width * height / 4)], 128 + 224 * red, 1.01);
    }
}

TEST_F(ReadbackTest, PicturesArriveInTheOrderOfStart) {
  Renderer renderer = make_renderer();
  std::vector<Image> expected;
  for (int i = 0; i < 5; ++i) {
    draw(renderer, 0.4 * i);
    expected.push_back(read(renderer));
  }
  Readback readback(PixelFormat::rgb, 160, 120, 2);
  std::vector<Image> got;
  Image image;
  for (int i = 0; i < 5; ++i) {
    draw(renderer, 0.4 * i);
    if (readback.full()) {
      readback.finish(image);
      got.push_back(image);
    }
    readback.start(renderer);
  }
  while (readback.pending() > 0) {
    readback.finish(image);
    got.push_back(image);
  }
  ASSERT_EQ(got.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(got[i].bytes, expected[i].bytes) << i;
  EXPECT_NE(got[0].bytes, got[4].bytes);
}

TEST_F(ReadbackTest, MisuseThrows) {
  Renderer renderer = make_renderer();
  EXPECT_THROW(Readback(PixelFormat::yuv420, 161, 120), std::invalid_argument);
  Readback other(PixelFormat::rgb, 80, 60);
  EXPECT_THROW(other.start(renderer), std::invalid_argument);
  Readback readback(PixelFormat::rgb, 160, 120, 1);
  readback.start(renderer);
  EXPECT_THROW(readback.start(renderer), std::logic_error);
  Image image;
  readback.finish(image);
  EXPECT_THROW(readback.finish(image), std::logic_error);
}

}  // namespace
}  // namespace mercury::render
