// SPDX-License-Identifier: Apache-2.0
#include "render/text/overlay.h"

#include <gtest/gtest.h>

#include <cmath>

#include "render/text/font.h"

namespace mercury::render {
namespace {

Overlay make_overlay() { return Overlay(640, 360, 16, style_of(Surroundings::water, Theme::dark)); }

std::vector<Rectangle> boxes_of(const Overlay& overlay) {
  std::vector<Rectangle> boxes;
  for (const OverlayQuad& quad : overlay.quads())
    if (quad.kind == OverlayQuad::box) boxes.push_back(quad.rectangle);
  return boxes;
}

Bounds box_at(float x, float y) { return {Vector3(x - 0.1f, y - 0.1f, -0.1f), Vector3(x + 0.1f, y + 0.1f, 0.1f)}; }

TEST(Font, ReadsUtf8AndMarksBrokenBytes) {
  EXPECT_EQ(characters_of("a\u00e9\u03c0\U0001f916"), (std::vector<int>{'a', 0xe9, 0x3c0, 0x1f916}));
  EXPECT_EQ(characters_of("\xc3"), std::vector<int>{0xfffd});
  EXPECT_EQ(characters_of("\xff"
                          "b"),
            (std::vector<int>{0xfffd, 'b'}));
}

TEST(Font, HasGlyphsForUnitsAndTheReplacementForOthers) {
  for (const int code : {int('0'), int('Z'), 0x2212, 0x3c0, 0xb7, 0xd7}) EXPECT_EQ(glyph_of(code).code, code);
  EXPECT_EQ(glyph_of(0x1f916).code, 0xfffd);
}

TEST(Font, WidthGrowsWithTextAndSize) {
  EXPECT_FLOAT_EQ(text_width("abab", 16), 2 * text_width("ab", 16));
  EXPECT_FLOAT_EQ(text_width("ab", 32), 2 * text_width("ab", 16));
}

TEST(TickText, HasJustEnoughDigitsToDistinguishNeighbors) {
  EXPECT_EQ(tick_text(0.2f, 0.2f), "0.2");
  EXPECT_EQ(tick_text(0.25f, 0.25f), "0.25");
  EXPECT_EQ(tick_text(0.375f, 0.125f), "0.375");
  EXPECT_EQ(tick_text(12.5f, 12.5f), "12.5");
  EXPECT_EQ(tick_text(2.0f / 3, 1.0f / 3), "0.67");
  EXPECT_EQ(tick_text(24.68f, 12.34f), "24.68");
  EXPECT_EQ(tick_text(36.963f, 12.321f), "37");
  EXPECT_EQ(tick_text(20, 5), "20");
  EXPECT_EQ(tick_text(-0.4f, 0.2f), "\u22120.4");
  EXPECT_EQ(tick_text(1e-9f, 0.1f), "0.0");
  EXPECT_EQ(tick_text(2e-5f, 1e-5f), "2e-05");
}

TEST(RoundLength, IsOneTwoOrFive) {
  EXPECT_FLOAT_EQ(round_length(0.99f), 0.5f);
  EXPECT_FLOAT_EQ(round_length(1), 1);
  EXPECT_FLOAT_EQ(round_length(48), 20);
  EXPECT_FLOAT_EQ(round_length(0.0071f), 0.005f);
}

TEST(Overlay, LabelIsAboveItsBody) {
  Orbit orbit{.azimuth = -1.57f, .elevation = 0.3f, .distance = 5};
  Overlay overlay = make_overlay();
  const std::vector<Bounds> bodies{box_at(0, 0)};
  const std::vector<Label> labels{{0, "eel"}};
  overlay.labels(labels, bodies, orbit.camera());
  const std::vector<Rectangle> boxes = boxes_of(overlay);
  ASSERT_EQ(boxes.size(), 1u);
  const Vector3 middle = orbit.camera().project({0, 0, 0}, 640, 360);
  EXPECT_NEAR(boxes[0].x + boxes[0].width / 2, middle.x, 1);
  EXPECT_LT(boxes[0].y + boxes[0].height, middle.y);
}

TEST(Overlay, TextIsAlignedToItsPoint) {
  const Orbit orbit{.azimuth = -1.57f, .elevation = 0.3f, .distance = 5};
  const Vector3 point = orbit.camera().project({0.3f, 0, 0.2f}, 640, 360);
  const auto middle_of = [&](float align_x) {
    Overlay overlay = make_overlay();
    const std::vector<Text> texts{{.at = {0.3f, 0, 0.2f}, .text = "HH", .align_x = align_x}};
    overlay.texts(texts, orbit.camera());
    const Rectangle &first = overlay.quads()[0].rectangle, &last = overlay.quads()[1].rectangle;
    EXPECT_NEAR(first.y + first.height / 2, point.y, 3);
    return (first.x + last.x + last.width) / 2;
  };
  const float width = text_width("HH", 16);
  EXPECT_NEAR(middle_of(0.5f), point.x, 1.5f);
  EXPECT_NEAR(middle_of(0), point.x + width / 2, 1.5f);
  EXPECT_NEAR(middle_of(1), point.x - width / 2, 1.5f);
}

TEST(Overlay, OfTwoOverlappingLabelsTheNearerStaysAboveItsBody) {
  const Orbit orbit{.azimuth = -1.57f, .elevation = 0.02f, .distance = 5};
  Overlay overlay = make_overlay();
  const std::vector<Bounds> bodies{box_at(0, 0.5f), box_at(0, 0)};
  const std::vector<Label> labels{{0, "behind"}, {1, "before"}};
  overlay.labels(labels, bodies, orbit.camera());
  const std::vector<Rectangle> boxes = boxes_of(overlay);
  ASSERT_EQ(boxes.size(), 2u);
  EXPECT_LT(boxes[1].y + boxes[1].height, 180) << "above the nearer body";
  const bool apart = boxes[0].x + boxes[0].width <= boxes[1].x || boxes[1].x + boxes[1].width <= boxes[0].x ||
                     boxes[0].y + boxes[0].height <= boxes[1].y || boxes[1].y + boxes[1].height <= boxes[0].y;
  EXPECT_TRUE(apart);
}

TEST(Overlay, BodiesBehindTheCameraOrHiddenHaveNoLabel) {
  const Orbit orbit{.azimuth = -1.57f, .elevation = 0.3f, .distance = 5};
  Overlay overlay = make_overlay();
  const std::vector<Bounds> bodies{box_at(0, -20), Bounds{}};
  const std::vector<Label> labels{{0, "behind"}, {1, "hidden"}, {7, "nobody"}};
  overlay.labels(labels, bodies, orbit.camera());
  EXPECT_TRUE(overlay.quads().empty());
}

TEST(Overlay, EverythingStaysInsideThePicture) {
  Overlay overlay = make_overlay();
  overlay.legend({.title = "strain",
                  .unit = "1",
                  .scale = Scale{-0.2f, 0.2f, Colormap::diverging},
                  .swatches = {{rgb(0xff0000), "muscle 1"}},
                  .wheel = {rgb(0xff0000), rgb(0x00ff00), rgb(0x0000ff)},
                  .histogram = {0.2f, 1, 0.5f}});
  overlay.clock("12.3 s");
  overlay.caption("Mercury\n12 robots");
  overlay.length(Orbit{}.camera());
  for (const OverlayQuad& quad : overlay.quads()) {
    if (quad.kind == OverlayQuad::glyph) continue;  // their margins may cross the edge
    EXPECT_GE(quad.rectangle.x, 0);
    EXPECT_GE(quad.rectangle.y, 0);
    EXPECT_LE(quad.rectangle.x + quad.rectangle.width, 640);
    EXPECT_LE(quad.rectangle.y + quad.rectangle.height, 360);
  }
}

// Bars beside the scale, the first at the bottom, as long as their shares.
// Names of robots that have exploded: they may lie anywhere, and several at one place.
TEST(Overlay, FreeTextsStayInThePictureAndApart) {
  const Orbit orbit{.azimuth = -1.57f, .elevation = 0.3f, .distance = 5};
  const Camera camera = orbit.camera();
  std::vector<Text> texts;
  for (const Vector3 at : {Vector3(0, 0, 0), Vector3(0, 0, 0), Vector3(0.01f, 0, 0), Vector3(-9, 0, 0),
                           Vector3(9, 0, 0), Vector3(0, 0, 9)})
    texts.push_back({.at = at, .text = "voxel-1-7", .free = true});
  Overlay overlay = make_overlay();
  overlay.texts(texts, camera);
  ASSERT_EQ(overlay.texts().size(), texts.size());
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const OverlayText& a = overlay.texts()[i];
    const float width = text_width(a.text, a.size);
    EXPECT_GE(a.x, 0);
    EXPECT_LE(a.x + width, 640);
    EXPECT_GE(a.y, 0);
    EXPECT_LE(a.y + a.size, 360);
    for (std::size_t j = 0; j < i; ++j) {
      const OverlayText& b = overlay.texts()[j];
      EXPECT_TRUE(std::abs(a.x - b.x) >= width || std::abs(a.y - b.y) >= a.size) << i << " " << j;
    }
  }
}

TEST(Overlay, LegendHasAHistogram) {
  Overlay without = make_overlay(), with = make_overlay();
  Legend legend{"speed", "m/s", Scale{0, 1, Colormap::viridis}, {}, {}};
  without.legend(legend);
  legend.histogram = {0.25f, 0, 1, 0.5f};
  with.legend(legend);
  std::vector<Rectangle> bars;
  Rectangle scale;
  for (const OverlayQuad& quad : with.quads()) {
    if (quad.kind == OverlayQuad::scale) scale = quad.rectangle;
    if (quad.kind == OverlayQuad::box && quad.rectangle.height > 20 && quad.source.x == 0)
      bars.push_back(quad.rectangle);
  }
  ASSERT_EQ(bars.size(), 3u) << "an empty part has no bar";
  EXPECT_EQ(with.quads().size(), without.quads().size() + 3);
  EXPECT_FLOAT_EQ(bars[0].width / bars[1].width, 0.25f);
  EXPECT_FLOAT_EQ(bars[2].width / bars[1].width, 0.5f);
  for (const Rectangle& bar : bars) EXPECT_LE(bar.x + bar.width, scale.x);
  EXPECT_GT(bars[0].y, bars[1].y);
  EXPECT_GE(bars[2].y, scale.y - 0.01f);
  EXPECT_LE(bars[0].y + bars[0].height, scale.y + scale.height + 0.01f);
}

TEST(Overlay, ScaleBarHasTheLengthThatItShows) {
  Orbit orbit{.target = {0, 0, 0}, .azimuth = -1.5707963f, .elevation = 0, .distance = 8};
  Overlay overlay = make_overlay();
  overlay.length(orbit.camera());
  // The bar is the longest box without round corners; it has a round length at the target's distance.
  float across = 0;
  for (const OverlayQuad& quad : overlay.quads())
    if (quad.kind == OverlayQuad::box && quad.source.x == 0) across = std::max(across, quad.rectangle.width);
  const float pixels_a_meter =
      orbit.camera().project({1, 0, 0}, 640, 360).x - orbit.camera().project({0, 0, 0}, 640, 360).x;
  const float meters = across / pixels_a_meter;
  EXPECT_NEAR(meters, round_length(meters * 1.001f), 1e-3f);
}

}  // namespace
}  // namespace mercury::render
