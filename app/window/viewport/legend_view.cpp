// SPDX-License-Identifier: Apache-2.0
#include "app/window/viewport/legend_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "app/window/toolkit/theme.h"
#include "app/window/toolkit/widgets.h"
#include "render/scale.h"

namespace mercury::window {
namespace {

constexpr float rows = 9;                         // height of a scale [lines]
constexpr float graph_width = 2.2f;               // of the histogram [text sizes]
constexpr float farthest = 3, narrowest = 0.02f;  // of a dragged end: positions on the scale of the drag's begin

ImU32 text_color(float opacity = 1) { return ImGui::GetColorU32(ImGuiCol_Text, opacity); }

std::string title_of(const render::Legend& legend) {
  return legend.unit.empty() ? legend.title : fmt::format("{} [{}]", legend.title, legend.unit);
}

float width_of(const render::Legend& legend, const std::vector<render::Tick>& ticks) {
  const float text = ImGui::GetFontSize();
  float width = std::max(5 * text, ImGui::CalcTextSize(title_of(legend).c_str()).x);
  for (const auto& [color, name] : legend.swatches)
    width = std::max(width, 1.4f * text + ImGui::CalcTextSize(name.c_str()).x);
  const float graph = legend.histogram.empty() ? 0 : graph_width * text;
  for (const render::Tick& tick : ticks)
    width = std::max(width, graph + 1.5f * text + ImGui::CalcTextSize(tick.text.c_str()).x);
  return width;
}

void draw_swatches(const render::Legend& legend, ImVec2 low) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float text = ImGui::GetFontSize();
  float y = low.y + 1.35f * text;
  for (const auto& [color, name] : legend.swatches) {
    list.AddRectFilled({low.x, y + 0.05f * text}, {low.x + text, y + 1.05f * text}, packed(color), 0.2f * text);
    list.AddText({low.x + 1.4f * text, y}, text_color(), name.c_str());
    y += 1.35f * text;
  }
}

}  // namespace

// The bar of colors: from `left` to `right`, the scale `axis` from `bottom` to `top`.
struct LegendView::Bar {
  float left, right, bottom, top;
  render::Scale axis;

  float height_of(float value) const { return bottom - render::position_on(axis, value) * (bottom - top); }
  float value_at(float y) const { return render::value_on(axis, (bottom - y) / (bottom - top)); }
};

// A button on an end of the scale. Returns true if the mouse changed the scale.
bool LegendView::drag_end(bool high, const render::Legend& legend, const Bar& bar, ViewSettings& view, EventLog& log) {
  const float text = ImGui::GetFontSize(), value = high ? legend.scale->high : legend.scale->low;
  const float y = std::clamp(bar.height_of(value), bar.top - text, bar.bottom + text);
  ImGui::SetCursorScreenPos({bar.left - 0.3f * text, y - 0.55f * text});
  ImGui::InvisibleButton(high ? "high" : "low", {bar.right - bar.left + 0.6f * text, 1.1f * text});
  log.item(high ? "legend.high" : "legend.low");
  const bool active = ImGui::IsItemActive(), hovered = ImGui::IsItemHovered();
  if (hovered || active) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeNS);
  if (!active) tooltip("drag to choose the value at this end; double click: fit the values again");
  ImGui::GetWindowDrawList()->AddRectFilled({bar.left - 0.25f * text, y - 0.1f * text},
                                            {bar.right + 0.25f * text, y + 0.1f * text},
                                            hovered || active ? palette().accent : text_color(), 0.1f * text);
  if (hovered && ImGui::IsMouseDoubleClicked(0)) {
    held_.reset();
    view.scale.reset();
    return true;
  }
  if (ImGui::IsItemActivated()) held_ = *legend.scale;
  if (!active || !held_ || !ImGui::IsMouseDragging(0, 3)) return false;
  const float position = (bar.bottom - ImGui::GetIO().MousePos.y) / (bar.bottom - bar.top);
  const bool both = view.color->is_signed && held_->low == -held_->high;  // zero stays in the middle
  const float nearest = both ? 0.5f : high ? 0.0f : 1.0f;
  const float moved = high ? std::clamp(position, nearest + narrowest, farthest)
                           : std::clamp(position, 1 - farthest, nearest - narrowest);
  float end = render::value_on(*held_, moved);
  if (!view.color->is_signed && !high) end = std::max(end, held_->logarithmic ? 1e-6f * held_->high : 0.0f);
  std::pair<float, float> scale = view.scale.value_or(std::pair(legend.scale->low, legend.scale->high));
  (high ? scale.second : scale.first) = end;
  if (both) (high ? scale.first : scale.second) = -end;
  if (!(scale.first < scale.second)) return false;
  view.scale = scale;
  return true;
}

bool LegendView::draw_scale(const render::Legend& legend, const Bar& bar, ViewSettings& view, EventLog& log) {
  constexpr int bands = 64;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float text = ImGui::GetFontSize();
  // During a drag, the ends are elsewhere on the bar than usual.
  const float top = std::min(bar.top, bar.height_of(legend.scale->high));
  const float bottom = std::max(bar.bottom, bar.height_of(legend.scale->low));
  for (int i = 0; i < bands; ++i) {
    const float low = bottom + (top - bottom) * static_cast<float>(i) / bands;
    const float high = bottom + (top - bottom) * static_cast<float>(i + 1) / bands;
    list.AddRectFilled({bar.left, high}, {bar.right, low + 0.5f},
                       packed(render::color_on(*legend.scale, bar.value_at(0.5f * (low + high)))));
  }
  const float graph = graph_width * text;
  for (std::size_t i = 0; i < legend.histogram.size(); ++i) {
    const auto count = static_cast<float>(legend.histogram.size());
    const auto at = [&](float bin) { return bar.height_of(render::value_on(*legend.scale, bin / count)); };
    const float low = at(static_cast<float>(i)), high = at(static_cast<float>(i + 1));
    const float right = bar.left - 0.3f * text;
    if (legend.histogram[i] > 0)
      list.AddRectFilled({right - legend.histogram[i] * (graph - 0.5f * text), high + 0.2f * (low - high)},
                         {right, low}, text_color(0.6f));
  }
  for (const render::Tick& tick : render::ticks_of(bar.axis)) {
    const float y = bar.bottom - tick.position * (bar.bottom - bar.top);
    list.AddLine({bar.right, y}, {bar.right + 0.25f * text, y}, text_color());
    list.AddText({bar.right + 0.4f * text, y - 0.5f * text}, text_color(), tick.text.c_str());
  }
  const bool high = drag_end(true, legend, bar, view, log);
  return drag_end(false, legend, bar, view, log) || high;
}

bool LegendView::draw(const std::optional<render::Legend>& legend, const ViewportArea& area, ViewSettings& view,
                      EventLog& log) {
  if (!ImGui::IsMouseDown(0) || !legend || !legend->scale) held_.reset();
  box_ = {};
  if (!legend) return false;
  const float text = ImGui::GetFontSize(), step = 1.35f * text;
  const std::vector<render::Tick> ticks =
      legend->scale ? render::ticks_of(*legend->scale) : std::vector<render::Tick>();
  const float width = width_of(*legend, ticks);
  const float lines = legend->scale ? rows : static_cast<float>(legend->swatches.size());
  const ImVec2 low{area.high.x - width - 1.6f * text, area.low.y + 1.2f * text};
  const ImVec2 box_low{low.x - 0.6f * text, low.y - 0.5f * text};
  const ImVec2 box_high{low.x + width + 0.6f * text, low.y + (lines + 1) * step + 0.4f * text};
  if (box_low.x < area.low.x || box_high.y > area.high.y) return false;  // no room
  box_ = {box_low, box_high};
  ImGui::SetNextWindowPos(box_low);
  ImGui::SetNextWindowSize({box_high.x - box_low.x, box_high.y - box_low.y});
  // Only a scale takes the mouse; swatches let it through to the picture.
  const ImGuiWindowFlags mouse = legend->scale ? ImGuiWindowFlags_None : ImGuiWindowFlags_NoInputs;
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
  ImGui::Begin("##legend", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoBringToFrontOnFocus |
                   ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoScrollWithMouse | mouse);
  ImGui::GetWindowDrawList()->AddRectFilled(box_low, box_high, palette().on_picture, 0.35f * text);
  ImGui::GetWindowDrawList()->AddText(low, text_color(), title_of(*legend).c_str());
  bool changed = false;
  if (legend->scale) {
    const float left = low.x + (legend->histogram.empty() ? 0 : graph_width * text);
    changed = draw_scale(*legend,
                         {.left = left,
                          .right = left + text,
                          .bottom = low.y + (lines + 1) * step - 0.3f * text,
                          .top = low.y + 1.9f * text,
                          .axis = held_.value_or(*legend->scale)},
                         view, log);
  } else {
    draw_swatches(*legend, low);
  }
  ImGui::End();
  ImGui::PopStyleVar();
  return changed;
}

}  // namespace mercury::window
