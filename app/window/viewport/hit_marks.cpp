// SPDX-License-Identifier: Apache-2.0
#include "app/window/viewport/hit_marks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cfloat>
#include <string>

#include "app/window/toolkit/theme.h"

namespace mercury::window {
namespace {

std::optional<ImVec2> on_screen(const ViewportArea& area, const render::Camera& camera, const render::Vector3& point) {
  const render::Vector3 p = camera.project(point, static_cast<int>(area.width()), static_cast<int>(area.height()));
  if (!p.is_finite() || p.z < camera.near) return std::nullopt;
  return ImVec2(area.low.x + p.x, area.low.y + p.y);
}

// Where a window of that size covers neither the two points nor the legend, if there is such a place.
ImVec2 free_corner(const ViewportArea& area, ImVec2 size, ImVec2 a, ImVec2 b, const Box& legend) {
  const float gap = 2 * ImGui::GetFontSize();
  const float right = std::max(a.x, b.x) + gap, left = std::min(a.x, b.x) - gap - size.x;
  const float above = std::min(a.y, b.y) - size.y - gap, below = std::max(a.y, b.y) + gap;
  const auto inside = [&](float x, float y) {
    return ImVec2(std::clamp(x, area.low.x, std::max(area.low.x, area.high.x - size.x)),
                  std::clamp(y, area.low.y, std::max(area.low.y, area.high.y - size.y)));
  };
  const ImVec2 corners[] = {inside(right, above), inside(left, above), inside(right, below), inside(left, below)};
  for (const ImVec2& corner : corners) {
    const Box box{corner, {corner.x + size.x, corner.y + size.y}};
    if (!box.meets(legend) && !box.holds(a) && !box.holds(b)) return corner;
  }
  return corners[1];
}

}  // namespace

std::optional<ImVec2> draw_hit_mark(LiveScene& scene, const Hit& hit, const ViewportArea& area,
                                    const render::Camera& camera) {
  const auto index = scene.pointed_snapshot().robots->index_of(hit.robot);
  const LivePicture& picture = scene.pointed_picture();
  if (!index || *index >= picture.offsets().size()) return std::nullopt;
  const Robot& robot = *scene.pointed_snapshot().robots->robots[*index].robot;
  const std::span<const Vec3> positions = picture.positions_of(*index);
  const auto place = [&](std::uint16_t mass) {
    return on_screen(area, camera, render::Vector3(positions[mass]) + picture.offsets()[*index]);
  };
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const float text = ImGui::GetFontSize(), thick = 0.16f * text, edge = 0.09f * text;
  const ImU32 mark = palette().warning, outline = palette().mark_outline;
  list.PushClipRect(area.low, area.high);
  if (hit.spring && *hit.spring < robot.springs.size()) {
    const auto a = place(robot.springs[*hit.spring].a), b = place(robot.springs[*hit.spring].b);
    if (a && b) {
      list.AddLine(*a, *b, outline, thick + 2 * edge);
      list.AddLine(*a, *b, mark, thick);
    }
  }
  const auto at = hit.mass < positions.size() ? place(hit.mass) : std::nullopt;
  if (at) {
    list.AddCircleFilled(*at, 0.3f * text + edge, outline);
    list.AddCircleFilled(*at, 0.3f * text, mark);
  }
  list.PopClipRect();
  return at;
}

void write_figures(const LiveScene& scene, const Hit& hit) {
  const HitDetails figures = scene.describe(hit);
  ImGui::TextUnformatted(figures.robot.c_str());
  ImGui::PushStyleColor(ImGuiCol_Text, palette().faint);
  const std::string speed = figures.mass.speed ? fmt::format("{:.3g} m/s", *figures.mass.speed) : "...";
  ImGui::Text("mass %d: %s, %zu springs", static_cast<int>(hit.mass), speed.c_str(), figures.mass.springs);
  ImGui::Text("at %.3f, %.3f, %.3f m", static_cast<double>(figures.mass.position.x),
              static_cast<double>(figures.mass.position.y), static_cast<double>(figures.mass.position.z));
  if (figures.spring) {
    ImGui::Text("spring: %s", figures.spring->material_name.c_str());
    ImGui::Text("strain %+.2f %%, force %+.3g N", 100 * static_cast<double>(figures.spring->strain),
                static_cast<double>(figures.spring->force));
    ImGui::Text("%.4g m, at rest %.4g m", static_cast<double>(figures.spring->length),
                static_cast<double>(figures.spring->rest_length));
  }
  ImGui::PopStyleColor();
}

float figures_height() { return 6 * ImGui::GetTextLineHeightWithSpacing() + 2 * ImGui::GetStyle().WindowPadding.y; }

bool draw_pinned_figures(LiveScene& scene, const Hit& hit, EventLog& log, const ViewportArea& area,
                         const render::Camera& camera, const Box& legend) {
  if (!scene.pointed_snapshot().robots->index_of(hit.robot)) return false;
  const auto at = draw_hit_mark(scene, hit, area, camera);
  const float text = ImGui::GetFontSize();
  const ImVec2 mass = at.value_or(ImVec2(area.low.x, area.high.y));
  // Beside the point that was clicked, too, so that a second click there reaches the robot.
  const ImVec2 clicked = on_screen(area, camera, hit.point).value_or(mass);
  const ImVec2 size{18 * text, figures_height() + 1.6f * text};
  const ImVec2 corner = free_corner(area, size, mass, clicked, legend);
  const float width = size.x, x = corner.x;
  if (at)
    ImGui::GetBackgroundDrawList()->AddLine(*at, {corner.x + (x > mass.x ? 0 : width), corner.y + 2 * text},
                                            palette().warning, 0.06f * text);
  ImGui::SetNextWindowPos(corner);
  ImGui::SetNextWindowSizeConstraints({width, 0}, {FLT_MAX, FLT_MAX});
  ImGui::Begin("##pinned", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoFocusOnAppearing);
  write_figures(scene, hit);
  const bool closed = ImGui::SmallButton("close");
  log.item("pinned.close");
  const ImVec2 low = ImGui::GetWindowPos();
  log.item("panel.Pinned", low, {low.x + ImGui::GetWindowWidth(), low.y + ImGui::GetWindowHeight()});
  ImGui::End();
  return !closed;
}

}  // namespace mercury::window
