// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/commands.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <numbers>

#include "app/live/scene_robots.h"
#include "app/window/toolkit/widgets.h"

namespace mercury::window {
namespace {

constexpr float half_turn = std::numbers::pi_v<float>, quarter_turn = half_turn / 2;

// The keys of a bookmark, as a part of a sentence; empty = none.
std::string hint(const PanelContext& context, Action first, std::size_t place, const char* what) {
  const auto action = static_cast<Action>(static_cast<std::size_t>(first) + place);
  const std::string keys = context.keys.keys_of(action);
  return keys.empty() ? "" : fmt::format("; {} {}", keys, what);
}

// One end of an axis in the corner.
struct End {
  int axis = 0;
  bool negative = false;
  ImVec2 at{0, 0};
  float depth = 0;  // toward the eye, -1 to 1
};

std::array<End, 6> ends_of(const render::Camera& camera, ImVec2 middle, float reach) {
  const render::Matrix4 view = camera.view();
  std::array<End, 6> ends;
  for (int i = 0; i < 6; ++i) {
    const float sign = i % 2 == 0 ? 1.0f : -1.0f;
    const render::Vector3 seen = sign * view.column(i / 2);
    ends[static_cast<std::size_t>(i)] = {
        i / 2, sign < 0, {middle.x + reach * seen.x, middle.y - reach * seen.y}, seen.z};
  }
  std::ranges::stable_sort(ends, {}, &End::depth);
  return ends;
}

ImU32 color_of(int axis, float depth) {
  constexpr ImU32 colors[] = {IM_COL32(232, 84, 84, 255), IM_COL32(110, 190, 75, 255), IM_COL32(82, 140, 240, 255)};
  const auto opacity = static_cast<ImU32>(170 + 85 * std::clamp(depth, 0.0f, 1.0f));
  return (colors[axis] & ~IM_COL32_A_MASK) | (opacity << IM_COL32_A_SHIFT);
}

void draw_end(ImDrawList& list, const End& end, ImVec2 middle, float radius, bool hovered) {
  constexpr const char* names[] = {"x", "y", "z"};
  const ImU32 color = hovered ? IM_COL32_WHITE : color_of(end.axis, end.depth);
  if (end.negative) {
    list.AddCircleFilled(end.at, 0.72f * radius, (color & ~IM_COL32_A_MASK) | IM_COL32(0, 0, 0, 90));
    list.AddCircle(end.at, 0.72f * radius, color, 0, 0.16f * radius);
    return;
  }
  list.AddLine(middle, end.at, color, 0.28f * radius);
  list.AddCircleFilled(end.at, radius, color);
  const ImVec2 size = ImGui::CalcTextSize(names[end.axis]);
  list.AddText({end.at.x - size.x / 2, end.at.y - size.y / 2}, IM_COL32(20, 24, 28, 255), names[end.axis]);
}

}  // namespace

void set_bookmark(PanelContext& context, std::size_t place) {
  ViewSettings view = context.scene.view();
  view.bookmarks.at(place) = context.camera.plan();
  context.scene.set_view(view);
  context.log.write("bookmark", {{"set", place + 1}});
  context.toasts.show(Tone::info, fmt::format("camera bookmark {} set{}", place + 1,
                                              hint(context, Action::bookmark_1, place, "goes back to it")));
}

void go_to_bookmark(PanelContext& context, std::size_t place) {
  const std::optional<CameraPlan>& plan = context.scene.view().bookmarks.at(place);
  if (!plan) {
    context.toasts.show(Tone::info, fmt::format("camera bookmark {} is not set{}", place + 1,
                                                hint(context, Action::set_bookmark_1, place, "sets it")));
    return;
  }
  std::optional<std::size_t> robot;
  const std::vector<RobotEntry> entries = context.scene.robots().entries();
  for (std::size_t i = 0; i < entries.size() && !plan->robot.empty(); ++i)
    if (entries[i].name == plan->robot || std::to_string(i) == plan->robot) robot = i;
  context.camera.go_to(*plan, robot);
  context.log.write("bookmark", {{"gone", place + 1}});
}

void look_along(PanelContext& context, int axis, bool from_negative) {
  OrbitController& camera = context.camera;
  if (axis == 2 && !from_negative) {
    camera.set_mode(CameraMode::top);
  } else if (axis == 2) {
    camera.look_from(-quarter_turn, -quarter_turn);
  } else {
    const float positive = axis == 0 ? 0 : quarter_turn;
    camera.look_from(from_negative ? positive - half_turn : positive, 0);
  }
  context.log.write("along", {{"axis", axis}, {"negative", from_negative}});
}

Box draw_axes(PanelContext& context, const ViewportArea& area, const render::Camera& camera, float above) {
  const float text = ImGui::GetFontSize(), radius = 0.62f * text, reach = 1.9f * text, side = 2 * (reach + radius);
  if (area.width() < 4 * side || area.height() < 3 * side) return {};
  ImVec2 low{area.high.x - side - 0.5f * text, area.high.y - side - 0.5f * text - above};
  if (context.legend.meets({low, {low.x + side, low.y + side}})) low.x = context.legend.low.x - side - 0.5f * text;
  ImGui::SetNextWindowPos(low);
  ImGui::SetNextWindowSize({side, side});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
  ImGui::Begin("##axes", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoFocusOnAppearing |
                   ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoNav);
  ImGui::PopStyleVar();
  const ImVec2 middle{low.x + side / 2, low.y + side / 2};
  for (const End& end : ends_of(camera, middle, reach)) {
    const std::string name = fmt::format("axes.{}{}", end.negative ? "-" : "", "xyz"[end.axis]);
    ImGui::SetCursorScreenPos({end.at.x - radius, end.at.y - radius});
    ImGui::PushID(name.c_str());
    ImGui::SetItemAllowOverlap();
    if (ImGui::InvisibleButton("end", {2 * radius, 2 * radius})) look_along(context, end.axis, end.negative);
    context.log.item(name);
    const bool hovered = ImGui::IsItemHovered();
    tooltip(fmt::format("look from {}{}", end.negative ? "-" : "+", "xyz"[end.axis]).c_str());
    ImGui::PopID();
    draw_end(*ImGui::GetWindowDrawList(), end, middle, radius, hovered);
  }
  ImGui::End();
  return {low, {low.x + side, low.y + side}};
}

}  // namespace mercury::window
