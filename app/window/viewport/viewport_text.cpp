// SPDX-License-Identifier: Apache-2.0
#include "app/window/viewport/viewport_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "app/window/toolkit/theme.h"
#include "app/window/toolkit/widgets.h"
#include "render/label_layout.h"
#include "render/overlay.h"

namespace mercury::window {
namespace {

ImU32 text_color() { return ImGui::GetColorU32(ImGuiCol_Text); }

void backing(ImVec2 low, ImVec2 high) {
  ImGui::GetBackgroundDrawList()->AddRectFilled(low, high, palette().on_picture, 0.35f * ImGui::GetFontSize());
}

// A line of text with a background; `at` is its upper left corner.
void line(ImVec2 at, const std::string& text) {
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  const float margin = 0.4f * ImGui::GetFontSize();
  backing({at.x - margin, at.y - 0.6f * margin}, {at.x + size.x + margin, at.y + size.y + 0.6f * margin});
  ImGui::GetBackgroundDrawList()->AddText(at, text_color(), text.c_str());
}

// The labels that there is room for (render/label_layout.h). `hovered`: the body under the mouse.
void draw_labels(const render::Scene& scene, std::span<const render::Bounds> bounds, const ViewportArea& area,
                 const render::Camera& camera, std::optional<std::size_t> hovered, EventLog& log) {
  const float margin = 0.4f * ImGui::GetFontSize();
  const int width = static_cast<int>(area.width()), height = static_cast<int>(area.height());
  std::vector<const render::Label*> labels;
  std::vector<render::LabelRequest> requests;
  for (const render::Label& label : scene.labels) {
    if (label.body >= bounds.size() || scene.placements[label.body].hidden) continue;
    const auto body = render::covered_by(bounds[label.body], camera, width, height);
    if (!body) continue;
    const ImVec2 size = ImGui::CalcTextSize(label.text.c_str());
    labels.push_back(&label);
    requests.push_back({.body = *body,
                        .width = size.x + 2 * margin,
                        .height = size.y + 1.2f * margin,
                        .depth = camera.project(bounds[label.body].center(), width, height).z,
                        .priority = label.priority,
                        .forced = label.forced || label.body == hovered});
  }
  const auto placed = render::place_labels(requests, {0, 0, area.width(), area.height()});
  for (std::size_t i = 0; i < placed.size(); ++i) {
    if (!placed[i]) continue;
    const ImVec2 at{area.low.x + placed[i]->x + margin, area.low.y + placed[i]->y + 0.6f * margin};
    line(at, labels[i]->text);
    log.item(fmt::format("label.{}", labels[i]->body), {at.x - margin, at.y - 0.6f * margin},
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
  const float depth = (camera.target - camera.eye).norm();
  const float pixels_per_meter = area.height() / (2 * depth * std::tan(camera.field_of_view / 2));
  const float meters = render::round_length(0.22f * area.width() / pixels_per_meter),
              across = meters * pixels_per_meter;
  const float text = ImGui::GetFontSize();
  const std::string name = meters < 0.01f ? fmt::format("{:g} mm", 1000 * meters)
                           : meters < 1   ? fmt::format("{:g} cm", 100 * meters)
                                          : fmt::format("{:g} m", meters);
  const ImVec2 end{area.high.x - 1.4f * text, area.high.y - 1.2f * text};
  backing({end.x - across - 0.5f * text, end.y - 1.7f * text}, {end.x + 0.5f * text, end.y + 0.5f * text});
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  list.AddRectFilled({end.x - across, end.y - 0.12f * text}, {end.x, end.y + 0.12f * text}, text_color());
  list.AddText({end.x - across / 2 - ImGui::CalcTextSize(name.c_str()).x / 2, end.y - 1.4f * text}, text_color(),
               name.c_str());
}

}  // namespace

render::Scene without_text(const render::Scene& scene) {
  render::Scene bare = scene;
  bare.labels = {};
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
  draw_labels(scene, bounds, area, camera, options.hovered, log);
  const Box caption = options.caption ? draw_caption(scene.caption, area, options, log) : Box{};
  if (options.clock && !scene.clock.empty()) line({area.low.x + text, area.high.y - 2 * text}, scene.clock);
  if (scene.scale_bar) draw_scale_bar(area, camera);
  list.PopClipRect();
  return caption;
}

}  // namespace mercury::window
