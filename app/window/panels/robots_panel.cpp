// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/robots_panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/window/panels/evolution_commands.h"
#include "app/window/panels/file_commands.h"
#include "app/window/panels/robot_commands.h"
#include "app/window/toolkit/theme.h"
#include "app/window/toolkit/widgets.h"

namespace mercury::window {
namespace {

void draw_work(PanelContext& context) {
  for (const Work& work : context.scene.work()) {
    ImGui::PushID(static_cast<int>(work.id));
    const float share = work.total > 0 ? static_cast<float>(work.done) / static_cast<float>(work.total) : 0;
    ImGui::ProgressBar(share, {ImGui::GetContentRegionAvail().x - 5 * ImGui::GetFontSize(), 0}, work.name.c_str());
    ImGui::SameLine();
    if (ImGui::Button("Cancel")) context.scene.cancel_work(work.id);
    ImGui::PopID();
  }
}

void show_details(const RobotEntry& entry) {
  ImGui::BeginTooltip();
  ImGui::TextUnformatted(entry.name.c_str());
  ImGui::PushStyleColor(ImGuiCol_Text, palette().faint);
  ImGui::Text("%zu masses, %zu springs, %zu faces", entry.masses, entry.springs, entry.faces);
  ImGui::TextUnformatted(entry.file.empty() ? "not saved yet" : entry.file.c_str());
  if (entry.tuned) ImGui::TextUnformatted("materials changed");
  if (entry.exploded) ImGui::Text("exploded at %.3f s", entry.exploded_at);
  ImGui::PopStyleColor();
  ImGui::EndTooltip();
}

}  // namespace

void RobotsPanel::draw(PanelContext& context) {
  draw_list(context);
  draw_work(context);
  draw_commands(context);
  random_.draw(context);
}

void RobotsPanel::draw_list(PanelContext& context) {
  LiveScene& scene = context.scene;
  const std::vector<RobotEntry> entries = scene.entries();
  const std::size_t selected = scene.selection().size();
  heading(fmt::format("{} robot{}{}", entries.size(), entries.size() == 1 ? "" : "s",
                      selected ? fmt::format(", {} selected", selected) : "")
              .c_str());
  // As many whole rows as fit above the rest of the panel, and the heading.
  const float line = ImGui::GetTextLineHeight() + 2 * ImGui::GetStyle().CellPadding.y;
  const float below =
      3 * ImGui::GetFrameHeightWithSpacing() + ImGui::GetStyle().ItemSpacing.y + random_.height(context);
  const float most = std::max(5.0f, std::floor((ImGui::GetWindowHeight() - ImGui::GetCursorPosY() - below) / line) - 1);
  const float height = (std::clamp(static_cast<float>(entries.size()), 3.0f, most) + 1) * line + 2;
  if (!ImGui::BeginTable("list", 3, ImGuiTableFlags_ScrollY | ImGuiTableFlags_RowBg | ImGuiTableFlags_BordersOuter,
                         {0, height}))
    return;
  ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthStretch);
  ImGui::TableSetupColumn("springs", ImGuiTableColumnFlags_WidthFixed);
  ImGui::TableSetupColumn("shown", ImGuiTableColumnFlags_WidthFixed);
  ImGui::TableSetupScrollFreeze(0, 1);
  ImGui::TableHeadersRow();
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(entries.size()));
  while (clipper.Step())
    for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
      const RobotEntry& entry = entries[static_cast<std::size_t>(i)];
      ImGui::PushID(static_cast<int>(entry.id));
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      draw_row(context, entry);
      ImGui::PopID();
    }
  ImGui::EndTable();
}

void RobotsPanel::draw_row(PanelContext& context, const RobotEntry& entry) {
  if (entry.selected) ImGui::TableSetBgColor(ImGuiTableBgTarget_RowBg1, ImGui::GetColorU32(ImGuiCol_Header));
  const bool changed = entry.unsaved && (entry.tuned || !entry.file.empty());
  if (entry.exploded) ImGui::PushStyleColor(ImGuiCol_Text, palette().bad);
  const std::string name = shortened(entry.name + (changed ? " *" : ""), ImGui::GetContentRegionAvail().x);
  if (entry.selected)
    ImGui::PushStyleColor(ImGuiCol_Header, IM_COL32_BLACK_TRANS);  // the whole row has the colour already
  const bool clicked = ImGui::Selectable(name.c_str(), entry.selected, ImGuiSelectableFlags_AllowDoubleClick);
  if (entry.selected) ImGui::PopStyleColor();
  if (clicked && ImGui::IsMouseDoubleClicked(0))
    frame_robots(context, {entry.id});
  else if (clicked)
    select(context, entry);
  if (entry.exploded) ImGui::PopStyleColor();
  context.log.item(fmt::format("robot.{}", ImGui::TableGetRowIndex() - 1));
  if (ImGui::IsItemHovered() && pointer_rests()) show_details(entry);
  ImGui::TableNextColumn();
  ImGui::PushStyleColor(ImGuiCol_Text, palette().faint);
  right_aligned(fmt::format("{}", entry.springs));
  ImGui::PopStyleColor();
  ImGui::TableNextColumn();
  bool shown = !entry.hidden;
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {ImGui::GetStyle().FramePadding.x, 0});
  if (ImGui::Checkbox("##shown", &shown)) context.scene.set_hidden(entry.id, !shown);
  ImGui::PopStyleVar();
  tooltip("draw this robot; physics goes on either way");
}

// A plain click selects one robot, Ctrl-click adds or removes it, Shift-click adds a range.
void RobotsPanel::select(PanelContext& context, const RobotEntry& entry) {
  LiveScene& scene = context.scene;
  if (ImGui::GetIO().KeyShift && anchor_ != 0) {
    bool inside = false;
    for (const RobotEntry& other : scene.entries()) {
      const bool end = other.id == anchor_ || other.id == entry.id;
      if (inside || end) scene.select(other.id, false);
      if (end && anchor_ != entry.id) inside = !inside;
    }
    return;
  }
  if (ImGui::GetIO().KeyCtrl)
    scene.toggle_selected(entry.id);
  else
    scene.select(entry.id);
  anchor_ = entry.id;
}

void RobotsPanel::draw_commands(PanelContext& context) {
  LiveScene& scene = context.scene;
  const std::vector<RobotId> selection = scene.selection();
  const float width = (ImGui::GetContentRegionAvail().x - 2 * ImGui::GetStyle().ItemSpacing.x) / 3;
  ImGui::BeginDisabled(selection.empty());
  if (ImGui::Button("Duplicate", {width, 0})) scene.duplicate(selection);
  context.log.item("duplicate");
  tooltip("add a copy of each selected robot (Ctrl D)");
  ImGui::SameLine();
  if (ImGui::Button("Mutate", {width, 0})) mutate_selected(context);
  context.log.item("mutate");
  tooltip("add a changed copy of each selected robot (key M)");
  ImGui::SameLine();
  if (ImGui::Button("Remove", {width, 0})) scene.remove(selection);
  context.log.item("remove");
  tooltip("remove the selected robots (Delete)");
  if (ImGui::Button("Evolve these...", {-1, 0})) evolve_selected(context);
  context.log.item("evolve");
  tooltip("let the selected robots evolve, in the background (key E)");
  ImGui::EndDisabled();
  if (ImGui::Button("Open...", {width, 0})) open_robots(context);
  context.log.item("open");
  tooltip("open robot files (Ctrl O), or drop files and folders on the window");
  ImGui::SameLine();
  ImGui::BeginDisabled(scene.entries().empty());
  if (ImGui::Button(selection.empty() ? "Save all..." : "Save...", {width, 0})) save_robots(context);
  context.log.item("save");
  tooltip("save the selected robots, or all if none is selected (Ctrl Shift S)");
  ImGui::SameLine();
  if (ImGui::Button("Clear", {width, 0})) scene.clear();
  context.log.item("clear");
  tooltip("remove all robots (Ctrl Z to undo)");
  ImGui::EndDisabled();
}

}  // namespace mercury::window
