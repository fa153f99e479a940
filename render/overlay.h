// SPDX-License-Identifier: Apache-2.0
// What is written on the picture: laid out in pixels, as rectangles that one draw call paints in order.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "render/camera.h"
#include "render/scene.h"
#include "render/style.h"

namespace mercury::render {

// Pixels from the upper left corner.
struct Rectangle {
  float x = 0, y = 0, width = 0, height = 0;
  friend bool operator==(const Rectangle&, const Rectangle&) = default;
};

// As shaders/overlay.vert reads it.
struct OverlayQuad {
  enum Kind : std::uint32_t { glyph, box, scale };
  Rectangle place;
  Rectangle source;               // glyph: texels of the atlas. box: corner radius in x. scale: unused
  float color[4] = {1, 1, 1, 1};  // linear, opacity
  float edge[4] = {0, 0, 0, 0};   // glyph: colour of the outline
  std::uint32_t kind = box;
  float sharpness = 1;    // glyph: pixels of the picture that 255 steps of the atlas span
  std::uint32_t map = 0;  // scale: Colormap
  std::uint32_t padding = 0;
};

// Collects quads.
class Overlay {
 public:
  Overlay(int width, int height, float text_size, const Style& style);

  float text_size() const { return text_size_; }
  std::span<const OverlayQuad> quads() const { return quads_; }

  // One line; (x, y) is its upper left corner, or upper middle or upper right one for align 0.5 or 1.
  void text(std::string_view utf8, float x, float y, float size, float align = 0, float opacity = 1);
  void box(const Rectangle& place, float radius, Color color, float opacity);
  // A vertical bar, the scale's high end up.
  void scale_bar(const Rectangle& place, Colormap map);

  // Names above bodies, given the box of each as it stands in the picture. Labels of bodies behind others, outside the
  // picture, or that would cover a label in front of them, are left out.
  void labels(std::span<const Label> labels, std::span<const Bounds> bodies, const Camera& camera);
  void legend(const Legend& legend);
  void clock(std::string_view text);
  void caption(std::string_view text);
  // A round length at the distance of the camera's target.
  void length(const Camera& camera);

 private:
  void backing(const Rectangle& place, float opacity);
  void label(const Rectangle& place, std::span<const std::string_view> lines);

  float width_, height_, text_size_;
  Style style_;
  std::vector<OverlayQuad> quads_;
};

// "0.25", "1e-05": as short as tells neighbouring ticks apart.
std::string tick_text(float value, float step);

// The longest of 1, 2, 5 times a power of ten that is not above `most`.
float round_length(float most);

}  // namespace mercury::render
