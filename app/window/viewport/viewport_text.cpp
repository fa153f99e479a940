// SPDX-License-Identifier: Apache-2.0
#include "app/window/viewport/viewport_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <string>
#include <utility>

#include "app/window/toolkit/theme.h"
#include "app/window/toolkit/widgets.h"
#include "render/text/label_layout.h"
#include "render/text/overlay.h"
#include "render/text/scale.h"

namespace mercury::window {
namespace {

ImU32 text_color(float opacity = 1) { return ImGui::GetColorU32(ImGuiCol_Text, opacity); }

void backing(ImVec2 low, ImVec2 high) {
  ImGui::GetBackgroundDrawList()->AddRectFilled(low, high, palette().on_view, 0.35f * ImGui::GetFontSize());
}

// A line of text with a background; `at` is its upper left corner.
void line(ImVec2 at, const std::string& text) {
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  const float margin = 0.4f * ImGui::GetFontSize();
  backing({at.x - margin, at.y - 0.6f * margin}, {at.x + size.x + margin, at.y + size.y + 0.6f * margin});
  ImGui::GetBackgroundDrawList()->AddText(at, text_color(), text.c_str());
}

// Texts that may move are the names of robots that were torn apart; they stand last.
std::size_t fixed_texts(const render::Scene& scene) {
  const auto first = std::ranges::find_if(scene.texts, [](const render::Text& text) { return text.free; });
  return static_cast<std::size_t>(first - scene.texts.begin());
}

// The labels that there is room for (render/text/label_layout.h).
void draw_labels(const render::Scene& scene, std::span<const render::Bounds> bounds, const ViewportArea& area,
                 const render::Camera& camera, const ViewportTextOptions& options, EventLog& log) {
  const float margin = 0.4f * ImGui::GetFontSize();
  const int width = static_cast<int>(area.width()), height = static_cast<int>(area.height());
  std::vector<std::pair<std::string, const std::string*>> labels;  // of the log, and what is drawn
  std::vector<render::LabelRequest> requests;
  for (const render::Label& label : scene.labels) {
    if (label.body >= bounds.size() || scene.placements[label.body].hidden) continue;
    const auto body = render::covered_by(bounds[label.body], camera, width, height);
    if (!body) continue;
    const ImVec2 size = ImGui::CalcTextSize(label.text.c_str());
    labels.emplace_back(fmt::format("label.{}", label.body), &label.text);
    requests.push_back({.body = *body,
                        .width = size.x + 2 * margin,
                        .height = size.y + 1.2f * margin,
                        .depth = camera.project(bounds[label.body].center(), width, height).z,
                        .priority = label.priority,
                        .forced = label.forced || label.body == options.hovered});
  }
  for (const render::Text& text : scene.texts.subspan(fixed_texts(scene))) {
    const render::Vector3 at = camera.project(text.at, width, height);
    if (!at.is_finite() || at.z < camera.near) continue;
    const ImVec2 size = ImGui::CalcTextSize(text.text.c_str());
    labels.emplace_back(fmt::format("wreck.{}", &text - &scene.texts[fixed_texts(scene)]), &text.text);
    requests.push_back({.body = {at.x, at.y, 0, 0},
                        .width = size.x + 2 * margin,
                        .height = size.y + 1.2f * margin,
                        .depth = at.z,
                        .priority = -1});
  }
  std::vector<render::Rectangle> covered;
  for (const Box& box : options.covered)
    covered.push_back({box.low.x - area.low.x, box.low.y - area.low.y, box.high.x - box.low.x, box.high.y - box.low.y});
  const auto placed = render::place_labels(requests, {0, 0, area.width(), area.height()}, covered);
  for (std::size_t i = 0; i < placed.size(); ++i) {
    if (!placed[i]) continue;
    const ImVec2 at{area.low.x + placed[i]->x + margin, area.low.y + placed[i]->y + 0.6f * margin};
    line(at, *labels[i].second);
    log.item(labels[i].first, {at.x - margin, at.y - 0.6f * margin},
             {at.x - margin + placed[i]->width, at.y - 0.6f * margin + placed[i]->height});
  }
}

// In the upper left corner, as far as there is room.
Box draw_caption(const std::string& caption, const ViewportArea& area, const ViewportTextOptions& options,
                 EventLog& log) {
  if (caption.empty()) return {};
  const float text = ImGui::GetFontSize();
  const ImVec2 at{area.low.x + text, area.low.y + options.top + text};
  const Box& legend = options.legend;
  const bool beside_legend = legend.meets({at, {area.high.x, at.y + 2 * text}});
  const float room = (beside_legend ? legend.low.x : area.high.x) - text - at.x;
  std::string fitting;
  std::istringstream lines(caption);
  for (std::string one; std::getline(lines, one);) {
    if (!fitting.empty()) fitting += '\n';
    fitting += shortened(one, std::max(3 * text, room));
  }
  line(at, fitting);
  const ImVec2 size = ImGui::CalcTextSize(fitting.c_str());
  const Box box{at, {at.x + size.x, at.y + size.y}};
  log.item("caption", box.low, box.high);
  return box;
}

// The scale bar: a round length, to scale at the distance of the camera's target.
void draw_scale_bar(const ViewportArea& area, const render::Camera& camera) {
  const auto [across, name] = render::scale_bar(camera, area.width(), area.height(), 0.22f);
  const float text = ImGui::GetFontSize();
  const ImVec2 end{area.high.x - 1.4f * text, area.high.y - 1.2f * text};
  backing({end.x - across - 0.5f * text, end.y - 1.7f * text}, {end.x + 0.5f * text, end.y + 0.5f * text});
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  list.AddRectFilled({end.x - across, end.y - 0.12f * text}, {end.x, end.y + 0.12f * text}, text_color());
  list.AddText({end.x - across / 2 - ImGui::CalcTextSize(name.c_str()).x / 2, end.y - 1.4f * text}, text_color(),
               name.c_str());
}

constexpr float rows = 9;                         // height of a scale [lines]
constexpr float graph_width = 2.2f;               // of the histogram [text sizes]
constexpr float farthest = 3, narrowest = 0.02f;  // of a dragged end: positions on the scale of the drag's begin

std::string title_of(const render::Legend& legend) {
  return legend.unit.empty() ? legend.title : fmt::format("{} [{}]", legend.title, legend.unit);
}

float width_of(const render::Legend& legend, const std::vector<render::Tick>& ticks) {
  const float text = ImGui::GetFontSize();
  float width = std::max(5 * text, ImGui::CalcTextSize(title_of(legend).c_str()).x);
  for (const auto& [color, name] : legend.swatches)
    width = std::max(width, 1.4f * text + ImGui::CalcTextSize(name.c_str()).x);
  const float graph = legend.histogram.empty() ? 0 : graph_width * text;
  if (!legend.wheel.empty()) width = std::max(width, 9 * text);
  for (const render::Tick& tick : ticks)
    width = std::max(width, graph + 1.5f * text + ImGui::CalcTextSize(tick.text.c_str()).x);
  return width;
}

constexpr float lines_of_wheel = 6.5f;

void draw_wheel(std::span<const render::Color> colors, ImVec2 center) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float text = ImGui::GetFontSize(), radius = 2.2f * text;
  const auto at = [&](float angle, float far) {
    return ImVec2{center.x + far * std::cos(angle), center.y - far * std::sin(angle)};
  };
  const float turn = 2 * std::numbers::pi_v<float>, step = turn / static_cast<float>(colors.size());
  for (std::size_t i = 0; i < colors.size(); ++i)
    list.AddCircleFilled(at(step * static_cast<float>(i), radius), 0.62f * step * radius, packed(colors[i]));
  for (const auto& [angle, number] : {std::pair{0.0f, "0°"}, {0.25f, "90°"}, {0.5f, "180°"}, {0.75f, "270°"}}) {
    const ImVec2 middle = at(angle * turn, radius + (angle == 0.25f || angle == 0.75f ? 1.0f : 1.5f) * text);
    const ImVec2 size = ImGui::CalcTextSize(number);
    list.AddText({middle.x - 0.5f * size.x, middle.y - 0.5f * size.y}, text_color(), number);
  }
  const ImVec2 size = ImGui::CalcTextSize("phase");
  list.AddText({center.x - 0.5f * size.x, center.y - 0.5f * size.y}, text_color(), "phase");
}

void draw_swatches(const render::Legend& legend, ImVec2 low, float width) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float text = ImGui::GetFontSize();
  float y = low.y + 1.35f * text;
  if (!legend.wheel.empty()) {
    draw_wheel(legend.wheel, {low.x + 0.5f * width, y + 0.5f * lines_of_wheel * text});
    y += lines_of_wheel * text;
  }
  for (const auto& [color, name] : legend.swatches) {
    if (color.a > 0)
      list.AddRectFilled({low.x, y + 0.05f * text}, {low.x + text, y + 1.05f * text}, packed(color), 0.2f * text);
    list.AddText({low.x + 1.4f * text, y}, text_color(), name.c_str());
    y += 1.35f * text;
  }
}

}  // namespace

render::Scene without_text(const render::Scene& scene) {
  render::Scene bare = scene;
  bare.labels = {};
  bare.texts = bare.texts.first(fixed_texts(bare));
  bare.legend.reset();
  bare.clock.clear();
  bare.caption.clear();
  bare.scale_bar = false;
  return bare;
}

Box draw_viewport_text(const render::Scene& scene, std::span<const render::Bounds> bounds, const ViewportArea& area,
                       const render::Camera& camera, const ViewportTextOptions& options, EventLog& log) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  list.PushClipRect(area.low, area.high);
  const float text = ImGui::GetFontSize();
  draw_labels(scene, bounds, area, camera, options, log);
  const Box caption = options.caption ? draw_caption(scene.caption, area, options, log) : Box{};
  if (options.clock && !scene.clock.empty()) line({area.low.x + text, area.high.y - 2 * text}, scene.clock);
  if (scene.scale_bar) draw_scale_bar(area, camera);
  list.PopClipRect();
  return caption;
}

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
  const bool active = ImGui::IsItemActive(), dragged = item_dragged(), hovered = ImGui::IsItemHovered();
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
  // Unlike IsMouseDragging(), also in the frame that lets go.
  if (!dragged || !held_ || ImGui::GetIO().MouseDragMaxDistanceSqr[0] < 3 * 3) return false;
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
    // Inside the bar: beside it, it would read as a second minus.
    list.AddLine({bar.right - 0.3f * text, y}, {bar.right, y}, text_color());
    list.AddText({bar.right + 0.4f * text, y - 0.5f * text}, text_color(), tick.text.c_str());
  }
  const bool high = drag_end(true, legend, bar, view, log);
  return drag_end(false, legend, bar, view, log) || high;
}

bool LegendView::draw(const std::optional<render::Legend>& legend, const ViewportArea& area, ViewSettings& view,
                      EventLog& log) {
  if (!(ImGui::IsMouseDown(0) || ImGui::IsMouseReleased(0)) || !legend || !legend->scale) held_.reset();
  box_ = {};
  if (!legend) return false;
  const float text = ImGui::GetFontSize(), step = 1.35f * text;
  const std::vector<render::Tick> ticks =
      legend->scale ? render::ticks_of(*legend->scale) : std::vector<render::Tick>();
  const float width = width_of(*legend, ticks);
  const float lines = legend->scale ? rows
                                    : static_cast<float>(legend->swatches.size()) +
                                          (legend->wheel.empty() ? 0 : lines_of_wheel * text / step);
  const ImVec2 low{area.high.x - width - 1.6f * text, area.low.y + 1.2f * text};
  const ImVec2 box_low{low.x - 0.6f * text, low.y - 0.5f * text};
  const ImVec2 box_high{low.x + width + 0.6f * text, low.y + (lines + 1) * step + 0.4f * text};
  if (box_low.x < area.low.x || box_high.y > area.high.y) return false;  // no room
  box_ = {box_low, box_high};
  ImGui::SetNextWindowPos(box_low);
  ImGui::SetNextWindowSize({box_high.x - box_low.x, box_high.y - box_low.y});
  // Only a scale takes the mouse; swatches let it through to the view.
  const ImGuiWindowFlags mouse = legend->scale ? ImGuiWindowFlags_None : ImGuiWindowFlags_NoInputs;
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
  ImGui::Begin("##legend", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoBringToFrontOnFocus |
                   ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoScrollWithMouse | mouse);
  ImGui::GetWindowDrawList()->AddRectFilled(box_low, box_high, palette().on_view, 0.35f * text);
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
    draw_swatches(*legend, low, width);
  }
  ImGui::End();
  ImGui::PopStyleVar();
  return changed;
}

}  // namespace mercury::window
