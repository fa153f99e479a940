// SPDX-License-Identifier: Apache-2.0
#include "render/text/overlay.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <numbers>
#include <utility>

#include "render/text/font.h"
#include "render/text/label_layout.h"

namespace mercury::render {
namespace {

void set(float (&to)[4], Color color, float opacity) {
  const auto light = linear_of(color);
  const std::array<float, 4> all{light[0], light[1], light[2], opacity};
  std::copy(all.begin(), all.end(), to);
}

std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    lines.push_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

constexpr float small = 0.82f;           // size of second lines
constexpr float histogram_width = 2.2f;  // [sizes of text]
constexpr float wheel_radius = 2.2f;     // to the middle of the ring [sizes of text]

}  // namespace

float round_length(float most) {
  const float power = std::pow(10.0f, std::floor(std::log10(std::max(most, 1e-30f))));
  for (const float factor : {5.0f, 2.0f, 1.0f})
    if (factor * power <= most * 1.0001f) return factor * power;
  return power;
}

ScaleBar scale_bar(const Camera& camera, float width, float height, float share) {
  const float distance = (camera.eye - camera.target).norm();
  const float pixels_per_meter = height / (2 * distance * std::tan(0.5f * camera.field_of_view));
  const float meters = round_length(share * width / pixels_per_meter);
  const auto [factor, unit] = meters < 0.01f ? std::pair(1000, "mm")
                              : meters < 1   ? std::pair(100, "cm")
                                             : std::pair(1, "m");
  char text[32];
  std::snprintf(text, sizeof text, "%g %s", double(float(factor) * meters), unit);
  return {.pixels = meters * pixels_per_meter, .text = text};
}

Overlay::Overlay(int width, int height, float text_size, const Style& style)
    : width_(float(width)), height_(float(height)),
      text_size_(text_size > 0 ? text_size : std::max(13.0f, std::round(float(height) / 42.0f))), style_(style) {}

void Overlay::text(std::string_view utf8, float x, float y, float size, float align, float opacity) {
  const FontData& font = font_data();
  const float scale = size / float(font.size);
  texts_.push_back({std::string(utf8), x, y, size, scale * font.ascent, align, opacity});
  float pen = x - align * text_width(utf8, size);
  const float base = y + scale * font.ascent;
  for (const int code : characters_of(utf8)) {
    const FontGlyph& glyph = glyph_of(code);
    OverlayQuad quad;
    quad.kind = OverlayQuad::glyph;
    quad.rectangle = {pen + scale * float(glyph.left), base + scale * float(glyph.top), scale * float(glyph.width),
                      scale * float(glyph.height)};
    quad.source = {float(glyph.x), float(glyph.y), float(glyph.width), float(glyph.height)};
    quad.sharpness = scale * float(font.spread) * 255 / 128;
    set(quad.color, style_.text, opacity);
    set(quad.edge, style_.text_edge, style_.text_edge_opacity * opacity);
    if (glyph.width > 0) quads_.push_back(quad);
    pen += scale * glyph.advance;
  }
}

void Overlay::box(const Rectangle& area, float radius, Color color, float opacity) {
  OverlayQuad quad;
  quad.rectangle = area;
  quad.source.x = radius;
  set(quad.color, color, opacity);
  quads_.push_back(quad);
}

void Overlay::scale_bar(const Rectangle& area, Colormap map) {
  OverlayQuad quad;
  quad.kind = OverlayQuad::scale;
  quad.rectangle = area;
  quad.map = std::uint32_t(map);
  quads_.push_back(quad);
}

void Overlay::backing(const Rectangle& area, float opacity) {
  box(area, 0.35f * text_size_, style_.text_edge, opacity);
}

void Overlay::label(const Rectangle& area, std::span<const std::string_view> lines) {
  backing(area, 0.5f);
  float y = area.y + 0.09f * text_size_;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const float size = text_size_ * (i == 0 ? 1 : small);
    text(lines[i], area.x + 0.5f * area.width, y, size, 0.5f, i == 0 ? 1.0f : 0.85f);
    y += size;
  }
}

void Overlay::labels(std::span<const Label> labels, std::span<const Bounds> bodies, const Camera& camera) {
  const float pad = 0.3f * text_size_;
  std::vector<const Label*> shown;
  std::vector<LabelRequest> requests;
  for (const Label& label : labels) {
    if (label.body >= bodies.size() || label.text.empty()) continue;
    const auto body = covered_by(bodies[label.body], camera, int(width_), int(height_));
    if (!body) continue;
    const std::vector<std::string_view> lines = lines_of(label.text);
    LabelRequest request{.body = *body,
                         .height = text_size_ * (1 + small * float(lines.size() - 1)) + 0.8f * pad,
                         .depth = camera.project(bodies[label.body].center(), int(width_), int(height_)).z,
                         .priority = label.priority,
                         .forced = label.forced};
    for (std::size_t i = 0; i < lines.size(); ++i)
      request.width = std::max(request.width, text_width(lines[i], text_size_ * (i == 0 ? 1 : small)) + 2 * pad);
    shown.push_back(&label);
    requests.push_back(request);
  }
  const auto placed = place_labels(requests, {0, 0, width_, height_});
  for (std::size_t i = 0; i < placed.size(); ++i)
    if (placed[i]) label(*placed[i], lines_of(shown[i]->text));
}

void Overlay::texts(std::span<const Text> texts, const Camera& camera) {
  std::vector<Rectangle> taken;  // by free texts
  for (const Text& t : texts) {
    const Vector3 at = camera.project(t.at, int(width_), int(height_));
    const float size = t.size * text_size_;
    if (at.z <= camera.near) continue;
    if (!t.free) {
      text(t.text, at.x, at.y - t.align_y * size, size, t.align_x);
      continue;
    }
    const float width = text_width(t.text, size), line = 1.2f * size;
    Rectangle area{std::clamp(at.x - t.align_x * width, 0.0f, std::max(0.0f, width_ - width)),
                   std::clamp(at.y - t.align_y * size, 0.0f, std::max(0.0f, height_ - line)), width, line};
    const auto covers = [&](const Rectangle& other) {
      return area.x < other.x + other.width && other.x < area.x + area.width && area.y < other.y + other.height &&
             other.y < area.y + area.height;
    };
    // Below those that are there, or not at all.
    for (auto other = std::ranges::find_if(taken, covers); other != taken.end();
         other = std::ranges::find_if(taken, covers))
      area.y = other->y + other->height;
    if (area.y + area.height > height_) continue;
    taken.push_back(area);
    text(t.text, area.x, area.y, size);
  }
}

void Overlay::histogram(const Rectangle& area, std::span<const float> shares) {
  const float step = area.height / float(shares.size());
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const float across = std::clamp(shares[i], 0.0f, 1.0f) * area.width;
    if (across <= 0) continue;
    const float top = area.y + area.height - float(i + 1) * step;
    box({area.x + area.width - across, top, across, 0.8f * step}, 0, style_.text, 0.6f);
  }
}

void Overlay::draw_scale(const Legend& legend, std::span<const Tick> ticks, float left, float top, float height) {
  const float size = text_size_, graph = legend.histogram.empty() ? 0 : histogram_width * size;
  const Rectangle area{std::round(left + graph), std::round(top), std::round(1.1f * size), height};
  if (graph > 0) histogram({left, area.y, area.x - left - 0.15f * size, height}, legend.histogram);
  scale_bar(area, legend.scale->map);
  for (const Tick& tick : ticks) {
    const float line = area.y + (1 - tick.position) * height;
    // Inside the bar: beside it, it would read as a second minus.
    box({area.x + 0.8f * area.width, line - 0.04f * size, 0.2f * area.width, std::max(1.0f, 0.08f * size)}, 0,
        style_.text, 0.9f);
    text(tick.text, area.x + area.width + 0.6f * size, line - 0.47f * size, 0.9f * size);
  }
}

void Overlay::draw_wheel(std::span<const Color> colors, float x, float y) {
  const float size = text_size_, radius = wheel_radius * size;
  // Dots that overlap a little make a ring.
  const float dot = 2.5f * std::numbers::pi_v<float> * radius / float(colors.size());
  for (std::size_t i = 0; i < colors.size(); ++i) {
    const float angle = 2 * std::numbers::pi_v<float> * float(i) / float(colors.size());
    box({x + radius * std::cos(angle) - 0.5f * dot, y - radius * std::sin(angle) - 0.5f * dot, dot, dot}, 0.5f * dot,
        colors[i], 1);
  }
  const float number = 0.8f * size;
  text("phase", x, y - 0.5f * number, number, 0.5f);
  text("0°", x + radius + 0.7f * size, y - 0.5f * number, number);
  text("90°", x, y - radius - 0.7f * size - number, number, 0.5f);
  text("180°", x - radius - 0.7f * size, y - 0.5f * number, number, 1);
  text("270°", x, y + radius + 0.6f * size, number, 0.5f);
}

void Overlay::legend(const Legend& legend) {
  const float size = text_size_, pad = 0.7f * size;
  const std::string title = legend.title + (legend.unit.empty() ? "" : " [" + legend.unit + "]");
  const std::vector<Tick> ticks = legend.scale ? ticks_of(*legend.scale) : std::vector<Tick>();
  const float graph = legend.histogram.empty() ? 0 : histogram_width * size;
  float widest = text_width(title, size);
  for (const Tick& tick : ticks) widest = std::max(widest, graph + 1.9f * size + text_width(tick.text, 0.9f * size));
  for (const auto& [color, name] : legend.swatches)
    widest = std::max(widest, 1.5f * size + text_width(name, 0.9f * size));
  const float bar = legend.scale ? std::round(std::clamp(0.36f * height_, 6 * size, 16 * size)) : 0;
  const float rows = 1.25f * size * float(legend.swatches.size());
  const float wheel = legend.wheel.empty() ? 0 : 2 * wheel_radius + 3.4f;  // with its numbers [sizes of text]
  if (wheel > 0) widest = std::max(widest, (2 * wheel_radius + 4.2f) * size);
  const float down = 1.5f * size + (bar > 0 ? bar + 0.6f * size : 0) + wheel * size + rows;
  const Rectangle panel{width_ - widest - 3 * pad, 0.5f * (height_ - down) - pad, widest + 2 * pad, down + 1.6f * pad};
  backing(panel, 0.55f);
  const float left = panel.x + pad;
  float y = panel.y + 0.8f * pad;
  text(title, left, y, size);
  y += 1.5f * size;
  if (legend.scale) {
    draw_scale(legend, ticks, left, y + 0.3f * size, bar);
    y += bar + 0.6f * size;
  }
  if (wheel > 0) {
    draw_wheel(legend.wheel, left + 0.5f * widest, y + 0.5f * wheel * size);
    y += wheel * size;
  }
  for (const auto& [color, name] : legend.swatches) {
    if (color.a > 0)
      box({left - 1, y + 0.12f * size - 1, 0.95f * size + 2, 0.95f * size + 2}, 0.2f * size + 1, style_.text, 0.35f);
    if (color.a > 0) box({left, y + 0.12f * size, 0.95f * size, 0.95f * size}, 0.2f * size, color, 1);
    text(name, left + 1.5f * size, y + 0.1f * size, 0.9f * size);
    y += 1.25f * size;
  }
}

void Overlay::clock(std::string_view shown) {
  const float size = text_size_, pad = 0.45f * size;
  const Rectangle area{size, height_ - 2.4f * size, text_width(shown, size) + 2 * pad, 1.4f * size};
  backing(area, 0.5f);
  text(shown, area.x + pad, area.y + 0.2f * size, size);
}

void Overlay::caption(std::string_view shown) {
  const float size = 1.15f * text_size_, pad = 0.45f * size;
  const std::vector<std::string_view> lines = lines_of(shown);
  float across = 0;
  for (std::size_t i = 0; i < lines.size(); ++i)
    across = std::max(across, text_width(lines[i], i == 0 ? size : small * size));
  const float down = size * (1 + small * float(lines.size() - 1));
  const Rectangle area{text_size_, text_size_, across + 2 * pad, down + 0.4f * size};
  if (lines.empty()) return;
  backing(area, 0.5f);
  float y = area.y + 0.2f * size;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    text(lines[i], area.x + pad, y, i == 0 ? size : small * size);
    y += i == 0 ? size : small * size;
  }
}

void Overlay::length(const Camera& camera) {
  const ScaleBar bar = render::scale_bar(camera, width_, height_, 0.2f);
  const float across = bar.pixels, size = text_size_;
  const float x = width_ - across - 1.5f * size, y = height_ - 1.3f * size, line = std::max(1.5f, 0.12f * size);
  backing({x - 0.5f * size, y - 1.35f * size, across + size, 2.05f * size}, 0.5f);
  text(bar.text, x + 0.5f * across, y - 1.2f * size, size, 0.5f);
  box({x, y, across, line}, 0, style_.text, 1);
  box({x, y - 0.25f * size, line, 0.5f * size + line}, 0, style_.text, 1);
  box({x + across - line, y - 0.25f * size, line, 0.5f * size + line}, 0, style_.text, 1);
}

}  // namespace mercury::render
