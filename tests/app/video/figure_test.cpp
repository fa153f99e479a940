// SPDX-License-Identifier: Apache-2.0
// What two pictures of a scene over two backdrops say about it.
#include "app/video/figure.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

namespace mercury::test {
namespace {

using testing::HasSubstr;

// What a pixel shows: light of its own, and the share of the backdrop that it leaves.
struct Seen {
  float own, left;
};

std::array<render::Image, 2> drawn(const std::vector<Seen>& pixels) {
  std::array<render::Image, 2> pictures;
  for (std::size_t i = 0; i < 2; ++i) {
    pictures.at(i) = {.width = static_cast<int>(pixels.size()), .height = 1, .bytes = {}};
    for (const Seen& pixel : pixels) {
      const float light = pixel.own + pixel.left * figure_backdrops.at(i);
      const render::Color color = render::color_of_linear({light, light, light});
      pictures.at(i).bytes.insert(pictures.at(i).bytes.end(), {color.r, color.g, color.b});
    }
  }
  return pictures;
}

// Nothing, a body, its shadow, an edge of the body.
const std::vector<Seen> scene{{0, 1}, {0.4f, 0}, {0, 0.3f}, {0.2f, 0.5f}};

TEST(Figure, OverAColorIsWhatThatBackdropWouldGive) {
  for (const render::Color background : {render::Color{}, render::rgb(0x000000), render::rgb(0x3070c0)}) {
    const render::Image image = matted(drawn(scene), background);
    ASSERT_EQ(image.format, render::PixelFormat::rgb);
    const auto light = render::linear_of(background);
    for (std::size_t i = 0; i < scene.size(); ++i)
      for (std::size_t channel = 0; channel < 3; ++channel) {
        const float expected = scene[i].own + scene[i].left * light[channel];
        EXPECT_NEAR(image.bytes[3 * i + channel], render::color_of_linear({expected, 0, 0}).r, 4) << i;
      }
  }
  EXPECT_EQ(matted(drawn(scene), {}).bytes[0], 255);  // exactly the background where nothing is
}

TEST(Figure, TransparentPixelsLookTheSameOverBlackAndOverWhite) {
  const auto pictures = drawn(scene);
  const render::Image image = matted(pictures, {0, 0, 0, 0});
  ASSERT_EQ(image.format, render::PixelFormat::rgba);
  const render::Image white = matted(pictures, {}), black = matted(pictures, render::rgb(0x000000));
  for (std::size_t i = 0; i < scene.size(); ++i) {
    const float opacity = static_cast<float>(image.bytes[4 * i + 3]) / 255;
    for (std::size_t channel = 0; channel < 3; ++channel) {
      const float own = opacity * static_cast<float>(image.bytes[4 * i + channel]);
      EXPECT_NEAR(own, black.bytes[3 * i + channel], 1.5);
      EXPECT_NEAR(own + 255 * (1 - opacity), white.bytes[3 * i + channel], 1.5);
    }
  }
  EXPECT_EQ(image.bytes[3], 0);
  EXPECT_EQ(image.bytes[7], 255);
}

TEST(Figure, IsCutOffAroundWhatItShows) {
  std::vector<Seen> row(20, Seen{0, 1});
  row[8] = {0.4f, 0};
  row[10] = {0, 0.5f};
  const PixelBox box = content_of(drawn(row), 2);
  EXPECT_EQ(box.left, 6);
  EXPECT_EQ(box.right, 13);
  EXPECT_EQ(cropped(matted(drawn(row), {}), box).width, 7);
  EXPECT_EQ(content_of(drawn(std::vector<Seen>(5, Seen{0, 1})), 2).right, 5);  // nothing to see: all of it
}

TEST(Figure, TextOfAnSvgIsText) {
  render::Overlay text(640, 480, 0, render::style_of(render::Surroundings::none, render::Theme::light));
  text.caption("A < B & C");
  text.legend({.title = "strain", .scale = render::Scale{}});
  const render::Image image{.width = 640, .height = 480, .bytes = std::vector<std::uint8_t>(640 * 480 * 3, 200)};
  const std::string svg = figure_svg(image, text, {10, 0, 640, 480}, 300, "a \"comment\"");
  EXPECT_THAT(svg, HasSubstr("width=\"2.1in\" height=\"1.6in\" viewBox=\"10 0 630 480\""));
  EXPECT_THAT(svg, HasSubstr(">A &lt; B &amp; C</text>"));
  EXPECT_THAT(svg, HasSubstr(">strain</text>"));
  EXPECT_THAT(svg, HasSubstr("<desc>a &quot;comment&quot;</desc>"));
  EXPECT_THAT(svg, HasSubstr("url(#scale-1)"));
  EXPECT_THAT(svg, HasSubstr("data:image/png;base64,iVBORw0KGgo"));
}

}  // namespace
}  // namespace mercury::test
