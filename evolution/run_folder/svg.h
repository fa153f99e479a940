// SPDX-License-Identifier: Apache-2.0
// Pictures of lines, areas and text as SVG. Lengths are in pixels, y points down.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace mercury {

struct Point {
  double x = 0, y = 0;
};

struct Box {
  double x = 0, y = 0, width = 0, height = 0;
  double right() const { return x + width; }
  double bottom() const { return y + height; }
};

enum class Anchor { start, middle, end };

struct TextStyle {
  double size = 13;
  std::string_view color = "#5a5f66";
  Anchor anchor = Anchor::start;
  bool bold = false;
  double turn = 0;  // degrees, clockwise
};

class Svg {
 public:
  Svg(double width, double height);

  void rectangle(const Box& box, std::string_view fill, double corner = 0);
  void line(Point a, Point b, std::string_view color, double width);
  // Through the points; a point that is not finite parts the line.
  void polyline(std::span<const Point> points, std::string_view color, double width);
  void polygon(std::span<const Point> points, std::string_view fill, double opacity);
  void circle(Point center, double radius, std::string_view fill, std::string_view stroke);
  // `at` is the middle of its height, and the place that the anchor names.
  void text(Point at, std::string_view text, const TextStyle& style);
  // What follows is drawn inside of the box only, until end_clip().
  void begin_clip(const Box& box);
  void end_clip();

  std::string document() const;

 private:
  std::string body_;
  double width_, height_;
  int clips_ = 0;
};

}  // namespace mercury
