// SPDX-License-Identifier: Apache-2.0
#include "app/window/viewport/comparison_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "app/scene/side_difference.h"
#include "app/window/toolkit/theme.h"
#include "app/window/toolkit/widgets.h"

namespace mercury::window {
namespace {

// In metres, centimetres or millimetres, with a sign.
std::string signed_length(double metres, const char* per = "") {
  const double size = std::abs(metres);
  if (size < 0.01) return fmt::format("{:+.1f} mm{}", 1000 * metres, per);
  if (size < 1) return fmt::format("{:+.1f} cm{}", 100 * metres, per);
  return fmt::format("{:+.2f} m{}", metres, per);
}

// A line with a background in the middle of an area, its upper edge at `top`.
void middle_line(const ViewportArea& area, float top, const std::string& text, ImU32 color, EventLog& log,
                 const std::string& name) {
  const float font = ImGui::GetFontSize(), margin = 0.4f * font;
  const std::string fitting = shortened(text, area.width() - 4 * margin);
  const ImVec2 size = ImGui::CalcTextSize(fitting.c_str());
  const ImVec2 at{std::clamp((area.low.x + area.high.x - size.x) / 2, area.low.x + 2 * margin, area.high.x), top};
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const ImVec2 low{at.x - margin, at.y - 0.5f * margin}, high{at.x + size.x + margin, at.y + size.y + 0.5f * margin};
  list.AddRectFilled(low, high, palette().on_picture, 0.35f * font);
  list.AddText(at, color, fitting.c_str());
  log.item(name, low, high);
}

}  // namespace

Halves halves_of(const ViewportArea& area) {
  constexpr float gap = 2;  // [pixels]
  const float middle = std::round((area.low.x + area.high.x) / 2);
  return {{area.low, {middle - gap / 2, area.high.y}}, {{middle + gap / 2, area.low.y}, area.high}};
}

float draw_side_titles(const LiveScene& scene, const Halves& halves, EventLog& log) {
  const Snapshot& snapshot = scene.snapshot();
  if (!snapshot.second) return 0;
  auto [first, second] = differences(snapshot.configuration, snapshot.second->configuration);
  if (first.empty()) first = second = "no difference";
  const float font = ImGui::GetFontSize(), top = halves.first.low.y + 0.6f * font;
  const ImU32 color = ImGui::GetColorU32(ImGuiCol_Text);
  middle_line(halves.first, top, first, color, log, "title.first");
  middle_line(halves.second, top, second, color, log, "title.second");
  ImGui::GetBackgroundDrawList()->AddRectFilled({halves.first.high.x, halves.first.low.y},
                                                {halves.second.low.x, halves.second.high.y}, palette().accent);
  return 1.4f * font;
}

std::string text_of(const GhostFigures& figures) {
  const char* whose = figures.of_parent ? "its parent" : "before its change";
  if (figures.ghost_exploded)
    return fmt::format("{}: exploded", figures.of_parent ? "the parent" : "before the change");
  const double farther = figures.robot_distance - figures.ghost_distance;
  std::string text = signed_length(farther);
  if (figures.ghost_distance > 1e-6) text += fmt::format(" ({:+.0f} %)", 100 * farther / figures.ghost_distance);
  text += fmt::format(", {} against {}", signed_length(figures.robot_speed - figures.ghost_speed, "/s"),
                      figures.of_parent ? whose : "itself unchanged");
  if (!figures.same_age) text += fmt::format(" at {:.1f} s", figures.age);
  return text;
}

void draw_ghost_figures(LiveScene& scene, const ViewportArea& area, const render::Camera& camera, EventLog& log) {
  const std::vector<GhostFigures> all = scene.ghost_figures();
  if (all.empty()) return;
  const auto bounds = scene.picture().last_boxes();
  const int width = static_cast<int>(area.width()), height = static_cast<int>(area.height());
  const float font = ImGui::GetFontSize();
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  list.PushClipRect(area.low, area.high);
  for (const GhostFigures& figures : all) {
    const auto robot = scene.snapshot().robots->index_of(figures.robot);
    if (!robot || *robot >= bounds.size() || bounds[*robot].empty() || scene.is_hidden(figures.robot)) continue;
    const Eigen::Vector3f middle = bounds[*robot].center();
    if ((middle - camera.eye).dot(camera.target - camera.eye) <= 0) continue;
    float low = 0, x = camera.project(middle, width, height).x();
    for (int corner = 0; corner < 8; ++corner) {
      const render::Bounds& box = bounds[*robot];
      const Eigen::Vector3f at((corner & 1) ? box.high.x() : box.low.x(), (corner & 2) ? box.high.y() : box.low.y(),
                               (corner & 4) ? box.high.z() : box.low.z());
      low = std::max(low, camera.project(at, width, height).y());
    }
    const std::string text = text_of(figures);
    const float half = ImGui::CalcTextSize(text.c_str()).x / 2 + font;
    x = std::clamp(x, std::min(half, area.width() / 2), std::max(area.width() - half, area.width() / 2));
    const float top = std::clamp(area.low.y + low + 0.3f * font, area.low.y, area.high.y - 2 * font);
    middle_line({{area.low.x + x - half, top}, {area.low.x + x + half, top}}, top, text,
                packed(ghost_color(scene.view().theme)), log, fmt::format("ghost.{}", *robot));
  }
  list.PopClipRect();
}

}  // namespace mercury::window
