// SPDX-License-Identifier: Apache-2.0

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <span>
#include <utility>
#include <vector>

#include "app/live/picking.h"
#include "app/live/scene_robots.h"
#include "app/live/scene_selection.h"
#include "app/live/scene_time.h"
#include "app/window/panels/commands.h"
#include "app/window/toolkit/theme.h"
#include "app/window/toolkit/widgets.h"
#include "mercury/material.h"

namespace mercury::window {
namespace {

constexpr MaterialId base_materials = 22;

void draw_material(VoxelEdit& edit, const Robot& robot, EventLog& log) {
  ImGui::SetNextItemWidth(8 * ImGui::GetFontSize());
  if (ImGui::BeginCombo("##material", name_of_material(robot, edit.material).c_str())) {
    const std::size_t known = robot.materials.empty() ? base_materials + 1u : robot.materials.size();
    for (MaterialId id = 1; id <= base_materials && id < known; ++id)
      if (ImGui::Selectable(fmt::format("{}##{}", name_of_material(robot, id), id).c_str(), id == edit.material))
        edit.material = id;
    ImGui::EndCombo();
  }
  log.item("edit.material");
  tooltip("what is added or painted");
}

}  // namespace

void toggle_body_editor(PanelContext& context) {
  if (context.body_edit.robot != 0) {
    context.body_edit.robot = 0;
    return;
  }
  const std::optional<RobotId> current = context.scene.selection().current();
  if (!current) {
    context.toasts.show(Tone::info, "select the robot to edit first");
    return;
  }
  if (!context.scene.robots().has_voxels(*current)) {
    context.toasts.show(Tone::info, fmt::format("{} has no grid of voxels; only voxel robots can be edited",
                                                name_of_robot(context.scene, *current)));
    return;
  }
  context.body_edit.robot = *current;
  context.scene.time().pause();  // a body that holds still is easier to hit
}

void draw_body_editor(PanelContext& context, const ViewportArea& area) {
  BodyEdit& body = context.body_edit;
  const DocumentRobot* robot = body.robot ? context.scene.document().find(body.robot) : nullptr;
  if (!robot) {
    body.robot = 0;
    return;
  }
  const float text = ImGui::GetFontSize();
  const float caption = context.scene.drawn().scene().caption.empty() ? 0 : 2 * text;
  ImGui::SetNextWindowPos({(area.low.x + area.high.x) / 2, area.low.y + 0.6f * text + caption}, ImGuiCond_Always,
                          {0.5f, 0});
  ImGui::SetNextWindowSizeConstraints({0, 0}, {std::max(10 * text, area.width() - text), 20 * text});
  ImGui::Begin("##bodyedit", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_AlwaysAutoResize);
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(shortened(robot->body.name, 8 * text).c_str());
  struct Tool {
    VoxelTool tool;
    const char* name;
    const char* help;
  };
  for (const Tool& tool : {Tool{VoxelTool::add, "Add", "a click on the skin puts a voxel there"},
                           {VoxelTool::remove, "Take away", "a click removes the voxel; loose parts go with it"},
                           {VoxelTool::paint, "Paint", "a click gives the voxel another material"}}) {
    ImGui::SameLine();
    if (toggle_button(tool.name, body.edit.tool == tool.tool)) body.edit.tool = tool.tool;
    context.log.item(fmt::format("edit.{}", tool.name));
    tooltip(tool.help);
  }
  const bool narrow = area.width() < 42 * text;
  if (!narrow) ImGui::SameLine();
  draw_material(body.edit, *robot->body.robot, context.log);
  ImGui::SameLine();
  ImGui::SetNextItemWidth(7 * text);
  int mirror = static_cast<int>(body.edit.mirror);
  if (ImGui::Combo("##mirror", &mirror, "no mirror\0mirror x\0mirror y\0mirror z\0"))
    body.edit.mirror = static_cast<Mirror>(mirror);
  context.log.item("edit.mirror");
  tooltip("do the same on the other side of the body's middle");
  ImGui::SameLine();
  if (ImGui::Button("Done")) body.robot = 0;
  context.log.item("edit.done");
  context.log.item(
      "panel.BodyEdit", ImGui::GetWindowPos(),
      {ImGui::GetWindowPos().x + ImGui::GetWindowWidth(), ImGui::GetWindowPos().y + ImGui::GetWindowHeight()});
  ImGui::End();
}

void draw_voxel_outline(PanelContext& context, const Hit& hit, const ViewportArea& area, const render::Camera& camera) {
  const BodyEdit& body = context.body_edit;
  if (body.robot == 0 || body.robot != hit.robot || !context.scene.robots().voxel_side(hit)) return;
  const DrawnScene& drawn = context.scene.drawn();
  const LiveRobots& robots = *context.scene.snapshot().robots;
  // The hit may be older than the last edit.
  const auto index = robots.index_of(hit.robot);
  if (!index || *index >= drawn.offsets().size()) return;
  const Robot& robot = *robots.robots[*index].robot;
  const std::span<const Vec3> positions = drawn.positions_of(*index);
  if (*hit.face >= robot.faces.size() || positions.size() != robot.masses.size()) return;
  // The side's corners: the triangle's, its right angle in the middle, and the one across from it.
  std::array<std::uint16_t, 3> corners{robot.faces[*hit.face].a, robot.faces[*hit.face].b, robot.faces[*hit.face].c};
  const auto length = [&](std::size_t i) {
    return (render::Vector3(robot.masses[corners[(i + 1) % 3]]) - render::Vector3(robot.masses[corners[(i + 2) % 3]]))
        .norm();
  };
  std::size_t middle = 0;
  for (std::size_t i = 1; i < 3; ++i)
    if (length(i) > length(middle)) middle = i;
  const auto place = [&](std::size_t i) {
    return render::Vector3(positions[corners[(middle + i) % 3]]) + drawn.offsets()[*index];
  };
  const render::Vector3 b = place(0), c = place(1), a = place(2), d = a + c - b;
  const render::Vector3 out = (c - b).cross(a - b);  // faces turn counter-clockwise, seen from outside
  const float edge = ((c - b).norm() + (a - b).norm()) / 2;
  const render::Vector3 depth = (body.edit.tool == VoxelTool::add ? edge : -edge) / std::max(1e-12f, out.norm()) * out;
  const std::array<render::Vector3, 4> side{a, b, c, d};
  std::array<ImVec2, 8> seen;
  for (std::size_t i = 0; i < 8; ++i) {
    const render::Vector3 corner = side[i % 4] + (i < 4 ? 0.0f : 1.0f) * depth;
    const render::Vector3 at = camera.project(corner, static_cast<int>(area.width()), static_cast<int>(area.height()));
    if (at.z <= camera.near) return;
    seen[i] = {area.low.x + at.x, area.low.y + at.y};
  }
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  list.PushClipRect(area.low, area.high);
  const ImU32 color = body.edit.tool == VoxelTool::remove ? palette().bad : palette().mark;
  for (const auto& [width, line] : {std::pair{0.28f, palette().mark_outline}, std::pair{0.14f, color}})
    for (std::size_t i = 0; i < 4; ++i) {
      const float thick = width * ImGui::GetFontSize();
      list.AddLine(seen[i], seen[(i + 1) % 4], line, thick);
      list.AddLine(seen[4 + i], seen[4 + (i + 1) % 4], line, thick);
      list.AddLine(seen[i], seen[4 + i], line, thick);
    }
  list.PopClipRect();
  context.log.item("voxel_outline", seen[0], seen[6]);
}

bool edit_body_at(PanelContext& context, const Hit& hit) {
  const BodyEdit& body = context.body_edit;
  if (body.robot == 0 || body.robot != hit.robot) return false;
  const std::optional<VoxelSide> side = context.scene.robots().voxel_side(hit);
  if (!side) return true;
  if (context.scene.robots().edit_voxel(hit.robot, *side, body.edit)) {
    const Robot& robot = *context.scene.document().find(hit.robot)->body.robot;
    context.log.write("edited", {{"masses", robot.masses.size()}, {"springs", robot.springs.size()}});
  }
  return true;
}

}  // namespace mercury::window
