// SPDX-License-Identifier: Apache-2.0
// Text, legend, clock and scale on the picture, laid out in pixels. Everything is a rectangle (OverlayQuad); one draw
// call paints all of them in order.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "render/camera.h"
#include "render/scene.h"
#include "render/style.h"

namespace mercury::render {

// In pixels, from the upper left corner.
struct Rectangle {
  float x = 0, y = 0, width = 0, height = 0;
  friend bool operator==(const Rectangle&, const Rectangle&) = default;
};

// The layout of shaders/overlay.vert.
struct OverlayQuad {
  enum Kind : std::uint32_t { glyph, box, scale };
  Rectangle rectangle;
  Rectangle source;               // glyph: texels of the atlas. box: corner radius in x. scale: unused
  float color[4] = {1, 1, 1, 1};  // linear, opacity
  float edge[4] = {0, 0, 0, 0};   // glyph: color of the outline
  std::uint32_t kind = box;
  float sharpness = 1;    // glyph: pixels of the picture per 255 steps of gray
  std::uint32_t map = 0;  // scale: Colormap
  std::uint32_t padding = 0;
};

// A line of text as it was asked for, for pictures whose text is not of pixels. (x, y) is its upper left, middle or
// right end, and `ascent` below y is its base line.
struct OverlayText {
  std::string text;
  float x = 0, y = 0, size = 0, ascent = 0, align = 0, opacity = 1;
};

// Lays out one picture's text and collects its quads.
class Overlay {
 public:
  Overlay(int width, int height, float text_size, const Style& style);

  float text_size() const { return text_size_; }
  std::span<const OverlayQuad> quads() const { return quads_; }
  std::span<const OverlayText> texts() const { return texts_; }
  const Style& style() const { return style_; }

  // One line of text. (x, y) is its upper left corner, or its upper middle (align 0.5) or upper right corner (align 1).
  void text(std::string_view utf8, float x, float y, float size, float align = 0, float opacity = 1);
  void box(const Rectangle& area, float radius, Color color, float opacity);
  // A vertical bar with the high end of the scale at the top.
  void scale_bar(const Rectangle& area, Colormap map);
  // Bars that grow to the left from the area's right edge, one per element, the first at the bottom.
  void histogram(const Rectangle& area, std::span<const float> shares);

  // Labels above bodies, given each body's box in the picture. Leaves out labels outside the picture and those that
  // would cover the label of a nearer body.
  void labels(std::span<const Label> labels, std::span<const Bounds> bodies, const Camera& camera);
  void texts(std::span<const Text> texts, const Camera& camera);
  void legend(const Legend& legend);
  void clock(std::string_view text);
  void caption(std::string_view text);
  // A round length at the distance of the camera's target.
  void length(const Camera& camera);

 private:
  void backing(const Rectangle& area, float opacity);
  void draw_scale(const Legend& legend, std::span<const Tick> ticks, float left, float top, float height);
  void draw_wheel(std::span<const Color> colors, float x, float y);
  void label(const Rectangle& area, std::span<const std::string_view> lines);

  float width_, height_, text_size_;
  Style style_;
  std::vector<OverlayQuad> quads_;
  std::vector<OverlayText> texts_;
};

// The longest of 1, 2, 5 times a power of ten that is not above `most`.
float round_length(float most);

// A round length, and how long it is in a picture at the distance of the camera's target.
struct ScaleBar {
  float pixels = 0;
  std::string text;  // "20 cm"
};
// At most this share of the picture's width, which is in pixels like its height.
ScaleBar scale_bar(const Camera& camera, float width, float height, float share);

}  // namespace mercury::render
