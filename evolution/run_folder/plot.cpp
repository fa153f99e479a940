// SPDX-License-Identifier: Apache-2.0
#include "evolution/run_folder/plot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <initializer_list>

#include "mercury/names.h"
#include "mercury/number_text.h"
#include "mercury/quantity.h"

namespace mercury {
namespace {

std::string pixels(double value) {
  std::string text = fixed_text(value, 2);
  while (text.back() == '0') text.pop_back();
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

void append(std::string& text, std::initializer_list<std::string_view> parts) {
  for (const std::string_view part : parts) text += part;
}

bool is_finite(PlotPoint point) { return std::isfinite(point.x) && std::isfinite(point.y); }

}  // namespace

Svg::Svg(double width, double height) : width_(width), height_(height) {}

void Svg::rectangle(const Box& box, std::string_view fill, double corner) {
  append(body_, {"<rect x=\"", pixels(box.x), "\" y=\"", pixels(box.y), "\" width=\"", pixels(box.width),
                 "\" height=\"", pixels(box.height), "\" fill=\"", fill});
  if (corner > 0) append(body_, {"\" rx=\"", pixels(corner)});
  body_ += "\"/>\n";
}

void Svg::line(PlotPoint a, PlotPoint b, std::string_view color, double width) {
  append(body_, {"<line x1=\"", pixels(a.x), "\" y1=\"", pixels(a.y), "\" x2=\"", pixels(b.x), "\" y2=\"", pixels(b.y),
                 "\" stroke=\"", color, "\" stroke-width=\"", pixels(width), "\"/>\n"});
}

void Svg::polyline(std::span<const PlotPoint> points, std::string_view color, double width) {
  append(body_, {"<path fill=\"none\" stroke=\"", color, "\" stroke-width=\"", pixels(width),
                 "\" stroke-linejoin=\"round\" stroke-linecap=\"round\" d=\""});
  bool pen_down = false;
  for (const PlotPoint& point : points) {
    if (is_finite(point)) append(body_, {pen_down ? "L" : "M", pixels(point.x), " ", pixels(point.y)});
    pen_down = is_finite(point);
  }
  body_ += "\"/>\n";
}

void Svg::polygon(std::span<const PlotPoint> points, std::string_view fill, double opacity) {
  append(body_, {"<polygon fill=\"", fill, "\" fill-opacity=\"", pixels(opacity), "\" points=\""});
  for (const PlotPoint& point : points) append(body_, {pixels(point.x), ",", pixels(point.y), " "});
  body_ += "\"/>\n";
}

void Svg::circle(PlotPoint center, double radius, std::string_view fill, std::string_view stroke) {
  append(body_, {"<circle cx=\"", pixels(center.x), "\" cy=\"", pixels(center.y), "\" r=\"", pixels(radius),
                 "\" fill=\"", fill, "\" stroke=\"", stroke, "\" stroke-width=\"1.5\"/>\n"});
}

void Svg::text(PlotPoint at, std::string_view text, const TextStyle& style) {
  constexpr std::string_view anchors[] = {"start", "middle", "end"};
  constexpr double baseline = 0.35;  // below the middle, as a share of the size
  const std::string place = pixels(at.x) + " " + pixels(at.y);
  append(body_, {"<text transform=\"translate(", place, ")"});
  if (style.turn != 0) append(body_, {" rotate(", pixels(style.turn), ")"});
  append(body_, {"\" y=\"", pixels(baseline * style.size), "\" font-size=\"", pixels(style.size), "\" fill=\"",
                 style.color, "\" text-anchor=\"", anchors[static_cast<int>(style.anchor)], "\""});
  if (style.bold) body_ += " font-weight=\"600\"";
  append(body_, {">", markup_text(text), "</text>\n"});
}

void Svg::begin_clip(const Box& box) {
  const std::string name = "clip" + std::to_string(++clips_);
  append(body_, {"<clipPath id=\"", name, "\">"});
  rectangle(box, "none");
  append(body_, {"</clipPath>\n<g clip-path=\"url(#", name, ")\">\n"});
}

void Svg::end_clip() { body_ += "</g>\n"; }

std::string Svg::document() const {
  const std::string width = pixels(width_), height = pixels(height_);
  std::string text;
  append(text, {"<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"", width, "\" height=\"", height,
                "\" viewBox=\"0 0 ", width, " ", height,
                "\" font-family=\"Inter, 'Segoe UI', 'Helvetica Neue', Helvetica, Arial, 'DejaVu Sans', sans-serif\">\n"
                "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n",
                body_, "</svg>\n"});
  return text;
}

namespace {

constexpr std::string_view grid_color = "#e7e9ec", axis_color = "#8a9099";
constexpr double tick_size = 12, title_size = 13;

// The power of ten at or below x > 0.
double power_of_ten(double x) { return std::pow(10, std::floor(std::log10(x))); }

double step_for(Range range, int most) {
  const double smallest = (range.high - range.low) / most;
  const double power = power_of_ten(smallest);
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= smallest * (1 - 1e-9)) return factor * power;
  return 10 * power;
}

std::size_t letters_in(std::string_view utf8) {
  return static_cast<std::size_t>(std::ranges::count_if(utf8, [](char byte) { return (byte & 0xc0) != 0x80; }));
}

// "m/s2" as "m/s" with a raised 2.
std::string with_raised_digits(std::string_view unit) {
  std::string text;
  for (const char letter : unit) {
    if (letter == '2')
      text += "\u00b2";
    else if (letter == '3')
      text += "\u00b3";
    else
      text += letter;
  }
  return text;
}

}  // namespace

Range widened(Range range) {
  const double size = std::max(std::abs(range.low), std::abs(range.high));
  if (range.high - range.low > 1e-9 * size) return range;
  const double half = size == 0 ? 1 : 0.1 * size;
  return {range.low - half, range.low + half};
}

std::vector<double> ticks_in(Range range, int most) {
  const double step = step_for(range, most);
  const double first = std::ceil(range.low / step - 1e-9);
  std::vector<double> ticks;
  for (int i = 0; i <= most && (first + i) * step <= range.high + 1e-9 * step; ++i) ticks.push_back((first + i) * step);
  return ticks;
}

std::string tick_text(double value, double step) {
  if (std::abs(value) < step / 2) return "0";
  if (std::abs(value) >= 1e7 || step < 1e-4) {
    char text[40];
    std::snprintf(text, sizeof text, "%.3g", value);
    return text;
  }
  const int digits = std::max(0, -static_cast<int>(std::floor(std::log10(step) + 1e-9)));
  const double size = std::abs(value);
  std::string text = value < 0 ? "\u2212" : "";  // a minus sign is as wide as a digit
  text.append(digits > 0 || size < 10'000 ? fixed_text(size, digits)
                                          : with_commas(static_cast<std::uint64_t>(std::llround(size))));
  return text;
}

void draw_left_axis(Svg& svg, const Box& box, const Scale& scale, std::string_view title) {
  const Range range{scale.low, scale.high};
  const int most = std::max(2, static_cast<int>(box.height / 50));
  std::size_t widest = 0;
  for (const double tick : ticks_in(range, most)) {
    const std::string text = tick_text(tick, step_for(range, most));
    svg.line({box.x, scale(tick)}, {box.right(), scale(tick)}, grid_color, 1);
    svg.text({box.x - 10, scale(tick)}, text, {.size = tick_size, .anchor = Anchor::end});
    widest = std::max(widest, letters_in(text));
  }
  const double title_at = box.x - 32 - 6.6 * static_cast<double>(std::min<std::size_t>(widest, 6));
  svg.text({title_at, box.y + box.height / 2}, title,
           {.size = title_size, .color = "#33373d", .anchor = Anchor::middle, .turn = -90});
}

void draw_bottom_axis(Svg& svg, const Box& box, const Scale& scale, std::string_view title, bool whole) {
  const Range range{scale.low, scale.high};
  const int most = std::max(2, static_cast<int>(box.width / 80));
  svg.line({box.x, box.bottom()}, {box.right(), box.bottom()}, axis_color, 1);
  for (const double tick : ticks_in(range, most)) {
    if (whole && tick != std::floor(tick)) continue;
    svg.line({scale(tick), box.bottom()}, {scale(tick), box.bottom() + 5}, axis_color, 1);
    svg.text({scale(tick), box.bottom() + 17}, tick_text(tick, step_for(range, most)),
             {.size = tick_size, .anchor = Anchor::middle});
  }
  svg.text({box.x + box.width / 2, box.bottom() + 40}, title,
           {.size = title_size, .color = "#33373d", .anchor = Anchor::middle});
}

std::string axis_title(const std::string& formula) {
  const std::optional<std::size_t> q = find_quantity(formula);
  if (!q || quantities()[*q].unit.empty()) return formula;
  return std::string(formula).append(" [").append(with_raised_digits(quantities()[*q].unit)).append("]");
}

}  // namespace mercury
