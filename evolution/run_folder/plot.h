// SPDX-License-Identifier: Apache-2.0
// Pictures of lines, areas and text as SVG. Lengths are in pixels, y points down.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mercury/run_folder.h"

namespace mercury {

struct PlotPoint {
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
  void line(PlotPoint a, PlotPoint b, std::string_view color, double width);
  // Through the points; a point that is not finite parts the line.
  void polyline(std::span<const PlotPoint> points, std::string_view color, double width);
  void polygon(std::span<const PlotPoint> points, std::string_view fill, double opacity);
  void circle(PlotPoint center, double radius, std::string_view fill, std::string_view stroke);
  // `at` is the middle of its height, and the place that the anchor names.
  void text(PlotPoint at, std::string_view text, const TextStyle& style);
  // What follows is drawn inside of the box only, until end_clip().
  void begin_clip(const Box& box);
  void end_clip();

  std::string document() const;

 private:
  std::string body_;
  double width_, height_;
  int clips_ = 0;
};

// From values to pixels.
struct Scale {
  double low = 0, high = 1;        // values
  double at_low = 0, at_high = 1;  // pixels
  double operator()(double value) const { return at_low + (value - low) / (high - low) * (at_high - at_low); }
};

// A range of values that is not empty.
struct Range {
  double low = 0, high = 1;
};
Range widened(Range range);

// Steps of 1, 2 or 5 times a power of ten: at most `most` of them in the range.
std::vector<double> ticks_in(Range range, int most);
// As many digits as a tick needs: "0.25", "1,000", "2e-07".
std::string tick_text(double value, double step);

// Lines across the box at the ticks of its left side, with numbers and a title.
void draw_left_axis(Svg& svg, const Box& box, const Scale& scale, std::string_view title);
// Numbers below the box.
void draw_bottom_axis(Svg& svg, const Box& box, const Scale& scale, std::string_view title, bool whole = false);

// "distance [m]" of a quantity; a formula as it is.
std::string axis_title(const std::string& formula);

// The picture progress.svg: scores over generations, one panel per objective; the living in the plane of two
// objectives; for map-elites the map.
std::string progress_plot(const RunHistory& run);

// Its panels. Each draws into a box; axes and their titles stand outside, 80 px to the left, 50 px below and 130 px to
// the right.
void draw_scores(Svg& svg, const Box& box, const RunHistory& run, std::size_t objective);
void draw_front(Svg& svg, const Box& box, const RunHistory& run);
void draw_map(Svg& svg, const Box& box, const RunHistory& run);

}  // namespace mercury
