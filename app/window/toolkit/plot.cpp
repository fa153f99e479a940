// SPDX-License-Identifier: Apache-2.0
#include "app/window/toolkit/plot.h"

#include <fmt/format.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>

#include "app/window/toolkit/theme.h"
#include "app/window/toolkit/widgets.h"
#include "render/text/overlay.h"

namespace mercury::window {
namespace {

struct Range {
  double low = 1e300, high = -1e300;
  void extend(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  bool empty() const { return !(low <= high); }
};

struct Frame {
  ImVec2 low, high;  // the plot area on the screen
  Range x, y;
  ImVec2 at(double px, double py) const {
    const double u = (px - x.low) / (x.high - x.low), v = (py - y.low) / (y.high - y.low);
    return {low.x + static_cast<float>(u) * (high.x - low.x), high.y - static_cast<float>(v) * (high.y - low.y)};
  }
};

// Leaves room above the highest value. Values that start not far from 0 get an axis that starts at 0.
Range rounded(Range range) {
  if (range.empty()) return {0, 1};
  if (range.low > 0 && range.low < 0.6 * range.high) range.low = 0;
  if (range.high - range.low < 1e-9 * std::max(1.0, std::abs(range.high))) {
    const double half = std::max(1e-6, 0.05 * std::abs(range.high));
    range = {range.low - half, range.high + half};
    if (range.low < 0 && range.high - half >= 0) range.low = 0;
  }
  range.high += 0.06 * (range.high - range.low);
  if (range.low < 0) range.low -= 0.06 * (range.high - range.low);
  return range;
}

void draw_axes(const Frame& frame, const PlotAxes& axes) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float text = ImGui::GetFontSize();
  const auto y_ticks = render::ticks(static_cast<float>(frame.y.low), static_cast<float>(frame.y.high), 5);
  for (const float tick : y_ticks) {
    const ImVec2 p = frame.at(frame.x.low, tick);
    list.AddLine(p, {frame.high.x, p.y}, palette().grid);
    const float step = y_ticks.size() > 1 ? y_ticks[1] - y_ticks[0] : 1;
    const std::string label = render::tick_text(tick, step);
    list.AddText({p.x - ImGui::CalcTextSize(label.c_str()).x - 0.3f * text, p.y - 0.5f * text}, palette().faint,
                 label.c_str());
  }
  auto x_ticks = render::ticks(static_cast<float>(frame.x.low), static_cast<float>(frame.x.high), 5);
  if (axes.x_whole) std::erase_if(x_ticks, [](float tick) { return std::abs(tick - std::round(tick)) > 1e-3f; });
  // The name of the x axis is beside the title, or at the end of the ticks if there is no room.
  const std::string title = axes.unit.empty() ? axes.title : fmt::format("{} [{}]", axes.title, axes.unit);
  const float x_width = ImGui::CalcTextSize(axes.x_title.c_str()).x, x_left = frame.high.x - x_width;
  const bool beside = frame.low.x + ImGui::CalcTextSize(title.c_str()).x + text < x_left;
  for (const float tick : x_ticks) {
    const ImVec2 p = frame.at(tick, frame.y.low);
    list.AddLine({p.x, frame.low.y}, {p.x, frame.high.y}, palette().grid);
    const float step = x_ticks.size() > 1 ? x_ticks[1] - x_ticks[0] : 1;
    const std::string label = render::tick_text(tick, step);
    const float width = ImGui::CalcTextSize(label.c_str()).x;
    const float x = std::clamp(p.x - width / 2, frame.low.x, frame.high.x - width);
    if (!beside && x + width + 0.5f * text > x_left) continue;
    list.AddText({x, frame.high.y + 0.15f * text}, palette().faint, label.c_str());
  }
  list.AddText({frame.low.x, frame.low.y - 1.25f * text}, ImGui::GetColorU32(ImGuiCol_Text), title.c_str());
  list.AddText({x_left, beside ? frame.low.y - 1.25f * text : frame.high.y + 0.15f * text}, palette().faint,
               axes.x_title.c_str());
}

// The line from a to b is inside the frame, along x, between these two shares of its length, from 0 to 1. It is outside
// everywhere if the second is not larger.
std::pair<float, float> shares_within(const Frame& frame, ImVec2 a, ImVec2 b) {
  if (a.x == b.x) return {0.0f, a.x < frame.low.x || a.x > frame.high.x ? 0.0f : 1.0f};
  const auto [enter, leave] = std::minmax({(frame.low.x - a.x) / (b.x - a.x), (frame.high.x - a.x) / (b.x - a.x)});
  return {std::max(enter, 0.0f), std::min(leave, 1.0f)};
}

// A line in pieces: `on` pixels are drawn, `off` are not. Only inside the frame: a zoomed line may be a million times
// as long.
void draw_pieces(const Frame& frame, const std::vector<ImVec2>& points, ImU32 color, float thickness, float on,
                 float off) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  float along = 0;  // of the current piece and the gap after it
  for (std::size_t i = 1; i < points.size(); ++i) {
    const ImVec2 from = points[i - 1], to = points[i];
    const auto [enter, leave] = shares_within(frame, from, to);
    if (!(leave > enter)) continue;
    const auto point_at = [&](float share) {
      return ImVec2{from.x + share * (to.x - from.x), from.y + share * (to.y - from.y)};
    };
    const ImVec2 a = point_at(enter), b = point_at(leave);
    const float length = std::hypot(b.x - a.x, b.y - a.y);
    const auto at = [&](float way) {
      const float share = length > 0 ? way / length : 0;
      return ImVec2{a.x + share * (b.x - a.x), a.y + share * (b.y - a.y)};
    };
    for (float way = 0; way < length;) {
      const float left = (along < on ? on : on + off) - along, next = std::min(length, way + std::max(left, 0.01f));
      if (along < on) list.AddLine(at(way), at(next), color, thickness);
      along += next - way;
      if (along >= on + off - 0.005f) along = 0;
      way = next;
    }
  }
}

void draw_line(const Frame& frame, const PlotLine& line) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  std::vector<ImVec2> points;
  const float thickness = 1.6f * ImGui::GetFontSize() / 17;
  const auto flush = [&] {
    if (points.size() > 1 && line.stroke != Stroke::solid)
      draw_pieces(frame, points, packed(line.color), thickness,
                  line.stroke == Stroke::dashed ? 5 * thickness : thickness,
                  line.stroke == Stroke::dashed ? 3 * thickness : 2 * thickness);
    else if (points.size() > 1)
      list.AddPolyline(points.data(), static_cast<int>(points.size()), packed(line.color), 0, thickness);
    else if (!points.empty())
      list.AddCircleFilled(points.front(), 0.2f * ImGui::GetFontSize(), packed(line.color));
    points.clear();
  };
  const std::size_t count = std::min(line.x.size(), line.y.size());
  const float pixel = 0.7f;
  for (std::size_t i = 0; i < count; ++i) {
    if (!std::isfinite(line.y[i])) {
      flush();
      continue;
    }
    const ImVec2 p = frame.at(line.x[i], line.y[i]);
    if (points.empty() || i + 1 == count || std::abs(p.x - points.back().x) + std::abs(p.y - points.back().y) > pixel)
      points.push_back(p);
  }
  flush();
}

double x_at(const Frame& frame, float pixel) {
  const double share = static_cast<double>((pixel - frame.low.x) / (frame.high.x - frame.low.x));
  return frame.x.low + share * (frame.x.high - frame.x.low);
}

void draw_upright(const Frame& frame, double x, ImU32 color) {
  if (x < frame.x.low || x > frame.x.high) return;
  const float pixel = frame.at(x, frame.y.low).x;
  ImGui::GetWindowDrawList()->AddLine({pixel, frame.low.y}, {pixel, frame.high.y}, color);
}

// Wheel, drag and double click over the plot, whose item was just drawn. `all`: everything there is along x.
void handle_mouse(const Frame& frame, const Range& all, PlotView& view) {
  const ImGuiIO& io = ImGui::GetIO();
  if (ImGui::IsItemHovered()) {
    ImGui::SetItemUsingMouseWheel();
    if (io.MouseWheel != 0) view.zoom(x_at(frame, io.MousePos.x), std::pow(0.8, io.MouseWheel), all.low, all.high);
    if (ImGui::IsMouseDoubleClicked(0)) view.range.reset();
  }
  if (ImGui::IsItemActivated()) view.goes = io.KeyCtrl;
  if (ImGui::IsItemDeactivated()) view.goes = false;
  if (ImGui::IsItemActive() && view.goes) view.went_to = std::clamp(x_at(frame, io.MousePos.x), all.low, all.high);
  if (ImGui::IsItemActive() && !view.goes && io.MouseDelta.x != 0)
    view.pan(x_at(frame, frame.low.x) - x_at(frame, frame.low.x + io.MouseDelta.x), all.low, all.high);
}

void show_values(const Frame& frame, const PlotAxes& axes, std::span<const PlotLine> lines) {
  const double x = x_at(frame, ImGui::GetIO().MousePos.x);
  draw_upright(frame, x, palette().faint);
  ImGui::BeginTooltip();
  ImGui::Text("%s %s", short_number(x).c_str(), axes.x_unit.c_str());
  for (const PlotLine& line : lines) {
    const auto next = std::lower_bound(line.x.begin(), line.x.end(), x);
    if (line.x.empty()) continue;
    const std::size_t i =
        std::min(static_cast<std::size_t>(next - line.x.begin()), std::min(line.x.size(), line.y.size()) - 1);
    ImGui::PushStyleColor(ImGuiCol_Text, packed(line.color));
    ImGui::TextUnformatted("\xe2\x80\xa2");
    ImGui::PopStyleColor();
    ImGui::SameLine();
    ImGui::Text("%s  %s %s", line.name.c_str(), short_number(line.y[i]).c_str(), axes.unit.c_str());
  }
  ImGui::EndTooltip();
}

}  // namespace

std::string short_number(double value) {
  if (!std::isfinite(value)) return "-";
  const double size = std::abs(value);
  if (size >= 1e9) return fmt::format("{:.3g} G", value / 1e9);
  if (size >= 1e6) return fmt::format("{:.3g} M", value / 1e6);
  if (size >= 1e4) return fmt::format("{:.3g} k", value / 1e3);
  if (size >= 1e3) return fmt::format("{:.0f}", value);
  return fmt::format("{:.3g}", value);
}

void plot_legend(std::span<const PlotLine> lines) {
  const float text = ImGui::GetFontSize(), end = ImGui::GetCursorPosX() + ImGui::GetContentRegionAvail().x;
  bool first = true;
  for (const PlotLine& line : lines) {
    const std::string name = shortened(line.name, 14 * text);
    const float width = 0.7f * text + ImGui::GetStyle().ItemSpacing.x + ImGui::CalcTextSize(name.c_str()).x;
    if (!first) {
      ImGui::SameLine();
      if (ImGui::GetCursorPosX() + width > end) ImGui::NewLine();
    }
    first = false;
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ImGui::GetWindowDrawList()->AddRectFilled({corner.x, corner.y + 0.3f * text},
                                              {corner.x + 0.6f * text, corner.y + 0.8f * text}, packed(line.color),
                                              0.1f * text);
    ImGui::Dummy({0.7f * text, text});
    ImGui::SameLine();
    ImGui::TextUnformatted(name.c_str());
  }
}

void PlotView::zoom(double at, double factor, double low, double high) {
  const auto [from, to] = range.value_or(std::pair(low, high));
  const double least = 1e-6 * std::max(1e-9, high - low);  // a plot of less has no digits left
  const double length = std::max(least, factor * (to - from));
  if (length >= high - low) {
    range.reset();
    return;
  }
  const double share = to > from ? std::clamp((at - from) / (to - from), 0.0, 1.0) : 0.5;
  range = {at - share * length, at + (1 - share) * length};
  pan(0, low, high);
}

void PlotView::pan(double distance, double low, double high) {
  if (!range) return;
  const double length = range->second - range->first;
  const double from = std::clamp(range->first + distance, low, std::max(low, high - length));
  range = {from, from + length};
}

void plot(const char* id, const PlotAxes& axes, std::span<const PlotLine> lines, PlotView* view) {
  const float text = ImGui::GetFontSize();
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const float width = std::max(8 * text, ImGui::GetContentRegionAvail().x);
  ImGui::InvisibleButton(id, {width, std::max(4 * text, axes.height)});
  Frame frame{.low = {corner.x + 3.2f * text, corner.y + 1.4f * text},
              .high = {corner.x + width - 0.3f * text, corner.y + axes.height - 1.3f * text}};
  Range all, y;
  for (const PlotLine& line : lines)
    for (const double value : line.x) all.extend(value);
  if (all.empty()) all = {0, 1};
  if (all.high - all.low < 1e-9) all.high = all.low + 1;
  frame.x = all;
  if (view && view->range) frame.x = {view->range->first, view->range->second};
  for (const PlotLine& line : lines)
    for (std::size_t i = 0; i < std::min(line.x.size(), line.y.size()); ++i)
      if (line.x[i] >= frame.x.low && line.x[i] <= frame.x.high) y.extend(line.y[i]);
  frame.y = rounded(y);
  if (view) handle_mouse(frame, all, *view);
  draw_axes(frame, axes);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.PushClipRect(frame.low, frame.high, true);
  for (const PlotLine& line : lines) draw_line(frame, line);
  list.PopClipRect();
  if (view && view->mark) draw_upright(frame, *view->mark, palette().accent);
  const bool hovered = ImGui::IsItemHovered() && ImGui::IsMouseHoveringRect(frame.low, frame.high);
  if (hovered) show_values(frame, axes, lines);
  if (view && !hovered && view->cursor) draw_upright(frame, *view->cursor, palette().faint);
  if (view && hovered) view->next_cursor = x_at(frame, ImGui::GetIO().MousePos.x);
}

}  // namespace mercury::window
