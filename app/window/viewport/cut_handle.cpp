// SPDX-License-Identifier: Apache-2.0
#include "app/window/viewport/cut_handle.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "app/window/toolkit/theme.h"
#include "app/window/toolkit/widgets.h"
#include "render/cut.h"

namespace mercury::window {
namespace {

constexpr float shortest = 12;  // line on which the handle moves; below it the mouse moves it up and down [pixels]

std::span<const float> floats(std::span<const Vec3> points) {
  return {points.empty() ? nullptr : &points.front().x, 3 * points.size()};
}

// The index in the snapshot of the first selected robot, or of the first one that is visible.
std::optional<std::size_t> robot_with_handle(LiveScene& scene) {
  const Snapshot& snapshot = scene.snapshot();
  const auto shown = [&](RobotId id) {
    const auto index = snapshot.robots->index_of(id);
    const bool seen = index && *index < scene.picture().offsets().size() && !snapshot.telemetry[*index].exploded;
    return seen && !scene.is_hidden(id) ? index : std::nullopt;
  };
  for (const RobotId id : scene.selection())
    if (const auto index = shown(id)) return index;
  for (const DocumentRobot& robot : scene.document().robots)
    if (const auto index = shown(robot.body.id)) return index;
  return std::nullopt;
}

ImVec2 on_screen(const ViewportArea& area, const render::Camera& camera, const render::Vector3& point) {
  const render::Vector3 p = camera.project(point, static_cast<int>(area.width()), static_cast<int>(area.height()));
  return {area.low.x + p.x, area.low.y + p.y};
}

// Where the mouse is on the line from `low` to `high`, in percent.
float percent_at(ImVec2 mouse, ImVec2 low, ImVec2 high, float before) {
  const ImVec2 line{high.x - low.x, high.y - low.y};
  const float squared = line.x * line.x + line.y * line.y;
  if (squared < shortest * shortest) return before - 0.5f * ImGui::GetIO().MouseDelta.y;
  return 100 * ((mouse.x - low.x) * line.x + (mouse.y - low.y) * line.y) / squared;
}

}  // namespace

bool CutHandle::draw(LiveScene& scene, const ViewportArea& area, const render::Camera& camera, ViewSettings& view,
                     EventLog& log) const {
  const std::optional<std::size_t> robot = view.cut ? robot_with_handle(scene) : std::nullopt;
  if (!robot) return false;
  const auto frame = render::cut_frame(view.cut->axis, floats(scene.snapshot().robots->robots[*robot].robot->masses),
                                       floats(scene.picture().positions_of(*robot)));
  if (!frame) return false;
  const auto at = [&](float place) {
    return on_screen(
        area, camera,
        scene.picture().offsets()[*robot] + frame->center + (place - frame->axis.dot(frame->center)) * frame->axis);
  };
  const ImVec2 low = at(frame->low), high = at(frame->high), handle = at(frame->place_of(*view.cut));
  const float text = ImGui::GetFontSize(), radius = 0.55f * text;
  if (!(handle.x > area.low.x + text && handle.x < area.high.x - text && handle.y > area.low.y + text &&
        handle.y < area.high.y - text))
    return false;
  ImGui::SetNextWindowPos({handle.x - 1.5f * radius, handle.y - 1.5f * radius});
  ImGui::SetNextWindowSize({3 * radius, 3 * radius});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
  ImGui::Begin("##cut", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoBringToFrontOnFocus |
                   ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoMove);
  ImGui::InvisibleButton("handle", {3 * radius, 3 * radius});
  log.item("cut.handle");
  const bool active = ImGui::IsItemActive(), marked = active || ImGui::IsItemHovered();
  if (!active) tooltip("drag: where each robot is cut");
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  list.PushClipRect(area.low, area.high);
  const ImU32 color = marked ? palette().accent : ImGui::GetColorU32(ImGuiCol_Text);
  list.AddLine(low, high, palette().on_picture, 0.32f * text);
  list.AddLine(low, high, color, 0.1f * text);
  for (const ImVec2 end : {low, high}) list.AddCircleFilled(end, 0.16f * text, color);
  list.AddCircleFilled(handle, radius + 0.1f * text, palette().on_picture);
  list.AddCircleFilled(handle, radius, color);
  list.AddCircle(handle, radius, IM_COL32(0, 0, 0, 160));
  list.PopClipRect();
  ImGui::End();
  ImGui::PopStyleVar(2);
  const ImVec2 moved = ImGui::GetIO().MouseDelta;
  if (!active || (moved.x == 0 && moved.y == 0)) return false;
  // A place in meters becomes a share of this robot, and of all others.
  view.cut->shift = 0;
  view.cut->percent = std::clamp(percent_at(ImGui::GetIO().MousePos, low, high, view.cut->percent), 0.0f, 100.0f);
  return true;
}

}  // namespace mercury::window
