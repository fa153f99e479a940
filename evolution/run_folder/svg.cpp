// SPDX-License-Identifier: Apache-2.0
#include "evolution/run_folder/svg.h"

#include <cmath>
#include <initializer_list>

#include "evolution/run_folder/number_text.h"

namespace mercury {
namespace {

std::string pixels(double value) {
  std::string text = fixed_text(value, 2);
  while (text.back() == '0') text.pop_back();
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string escaped(std::string_view text) {
  std::string out;
  for (const char letter : text) {
    if (letter == '&')
      out += "&amp;";
    else if (letter == '<')
      out += "&lt;";
    else if (letter == '>')
      out += "&gt;";
    else if (letter == '"')
      out += "&quot;";
    else if (static_cast<unsigned char>(letter) >= 0x20)
      out += letter;
  }
  return out;
}

void append(std::string& text, std::initializer_list<std::string_view> parts) {
  for (const std::string_view part : parts) text += part;
}

bool is_finite(Point point) { return std::isfinite(point.x) && std::isfinite(point.y); }

}  // namespace

Svg::Svg(double width, double height) : width_(width), height_(height) {}

void Svg::rectangle(const Box& box, std::string_view fill, double corner) {
  append(body_, {"<rect x=\"", pixels(box.x), "\" y=\"", pixels(box.y), "\" width=\"", pixels(box.width),
                 "\" height=\"", pixels(box.height), "\" fill=\"", fill});
  if (corner > 0) append(body_, {"\" rx=\"", pixels(corner)});
  body_ += "\"/>\n";
}

void Svg::line(Point a, Point b, std::string_view color, double width) {
  append(body_, {"<line x1=\"", pixels(a.x), "\" y1=\"", pixels(a.y), "\" x2=\"", pixels(b.x), "\" y2=\"", pixels(b.y),
                 "\" stroke=\"", color, "\" stroke-width=\"", pixels(width), "\"/>\n"});
}

void Svg::polyline(std::span<const Point> points, std::string_view color, double width) {
  append(body_, {"<path fill=\"none\" stroke=\"", color, "\" stroke-width=\"", pixels(width),
                 "\" stroke-linejoin=\"round\" stroke-linecap=\"round\" d=\""});
  bool pen_down = false;
  for (const Point& point : points) {
    if (is_finite(point)) append(body_, {pen_down ? "L" : "M", pixels(point.x), " ", pixels(point.y)});
    pen_down = is_finite(point);
  }
  body_ += "\"/>\n";
}

void Svg::polygon(std::span<const Point> points, std::string_view fill, double opacity) {
  append(body_, {"<polygon fill=\"", fill, "\" fill-opacity=\"", pixels(opacity), "\" points=\""});
  for (const Point& point : points) append(body_, {pixels(point.x), ",", pixels(point.y), " "});
  body_ += "\"/>\n";
}

void Svg::circle(Point center, double radius, std::string_view fill, std::string_view stroke) {
  append(body_, {"<circle cx=\"", pixels(center.x), "\" cy=\"", pixels(center.y), "\" r=\"", pixels(radius),
                 "\" fill=\"", fill, "\" stroke=\"", stroke, "\" stroke-width=\"1.5\"/>\n"});
}

void Svg::text(Point at, std::string_view text, const TextStyle& style) {
  constexpr std::string_view anchors[] = {"start", "middle", "end"};
  constexpr double baseline = 0.35;  // below the middle, as a share of the size
  const std::string place = pixels(at.x) + " " + pixels(at.y);
  append(body_, {"<text transform=\"translate(", place, ")"});
  if (style.turn != 0) append(body_, {" rotate(", pixels(style.turn), ")"});
  append(body_, {"\" y=\"", pixels(baseline * style.size), "\" font-size=\"", pixels(style.size), "\" fill=\"",
                 style.color, "\" text-anchor=\"", anchors[static_cast<int>(style.anchor)], "\""});
  if (style.bold) body_ += " font-weight=\"600\"";
  append(body_, {">", escaped(text), "</text>\n"});
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

}  // namespace mercury
