// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/robots_panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/window/panels/file_commands.h"
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

void figures_of(const RobotEntry& entry) {
  ImGui::BeginTooltip();
  ImGui::TextUnformatted(entry.name.c_str());
  ImGui::PushStyleColor(ImGuiCol_Text, palette().faint);
  ImGui::Text("%zu masses, %zu springs, %zu faces", entry.masses, entry.springs, entry.faces);
  ImGui::TextUnformatted(entry.file.empty() ? "not saved yet" : entry.file.c_str());
  if (entry.tuned) ImGui::TextUnformatted("its materials were changed");
  if (entry.exploded) ImGui::Text("exploded at %.3f s", entry.exploded_at);
  ImGui::PopStyleColor();
  ImGui::EndTooltip();
}

}  // namespace

void RobotsPanel::draw(PanelContext& context, float aspect) {
  draw_list(context, aspect);
  draw_work(context);
  draw_changes(context);
  random.draw(context);
}

void RobotsPanel::draw_list(PanelContext& context, float aspect) {
  LiveScene& scene = context.scene;
  const std::vector<RobotEntry> entries = scene.entries();
  const std::size_t selected = scene.selection().size();
  heading(fmt::format("{} robot{}{}", entries.size(), entries.size() == 1 ? "" : "s",
                      selected ? fmt::format(", {} selected", selected) : "")
              .c_str());
  // Whole rows, and the heading: as many as leave room for what is below.
  const float line = ImGui::GetTextLineHeight() + 2 * ImGui::GetStyle().CellPadding.y;
  const float below = 2 * ImGui::GetFrameHeightWithSpacing() + ImGui::GetStyle().ItemSpacing.y + random.height();
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
      draw_row(context, entry, aspect);
      ImGui::PopID();
    }
  ImGui::EndTable();
}

void RobotsPanel::draw_row(PanelContext& context, const RobotEntry& entry, float aspect) {
  if (entry.selected) ImGui::TableSetBgColor(ImGuiTableBgTarget_RowBg1, ImGui::GetColorU32(ImGuiCol_Header));
  const bool changed = entry.unsaved && (entry.tuned || !entry.file.empty());
  if (entry.exploded) ImGui::PushStyleColor(ImGuiCol_Text, palette().bad);
  const std::string name = shortened(entry.name + (changed ? " *" : ""), ImGui::GetContentRegionAvail().x);
  if (entry.selected) ImGui::PushStyleColor(ImGuiCol_Header, IM_COL32_BLACK_TRANS);  // all of the row has the colour
  const bool clicked = ImGui::Selectable(name.c_str(), entry.selected, ImGuiSelectableFlags_AllowDoubleClick);
  if (entry.selected) ImGui::PopStyleColor();
  if (clicked && ImGui::IsMouseDoubleClicked(0))
    frame_robots(context, {entry.id}, aspect);
  else if (clicked)
    choose(context, entry);
  if (entry.exploded) ImGui::PopStyleColor();
  context.log.item(fmt::format("robot.{}", ImGui::TableGetRowIndex() - 1));
  if (ImGui::IsItemHovered() && pointer_rests()) figures_of(entry);
  ImGui::TableNextColumn();
  ImGui::PushStyleColor(ImGuiCol_Text, palette().faint);
  right_aligned(fmt::format("{}", entry.springs));
  ImGui::PopStyleColor();
  ImGui::TableNextColumn();
  bool shown = !entry.hidden;
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {ImGui::GetStyle().FramePadding.x, 0});
  if (ImGui::Checkbox("##shown", &shown)) context.scene.set_hidden(entry.id, !shown);
  ImGui::PopStyleVar();
  tooltip("whether it is drawn; it swims on either way");
}

// As in other lists: Ctrl adds one or takes it away, Shift adds all from the one clicked last.
void RobotsPanel::choose(PanelContext& context, const RobotEntry& entry) {
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

void RobotsPanel::draw_changes(PanelContext& context) {
  LiveScene& scene = context.scene;
  const std::vector<RobotId> selection = scene.selection();
  const float width = (ImGui::GetContentRegionAvail().x - 2 * ImGui::GetStyle().ItemSpacing.x) / 3;
  ImGui::BeginDisabled(selection.empty());
  if (ImGui::Button("Duplicate", {width, 0})) scene.duplicate(selection);
  context.log.item("duplicate");
  tooltip("a copy of each selected robot (Ctrl D)");
  ImGui::SameLine();
  if (ImGui::Button("Mutate", {width, 0})) mutate(context);
  context.log.item("mutate");
  tooltip("a changed copy of each selected robot (key M)");
  ImGui::SameLine();
  if (ImGui::Button("Remove", {width, 0})) scene.remove(selection);
  context.log.item("remove");
  tooltip("remove the selected robots (Delete)");
  ImGui::EndDisabled();
  if (ImGui::Button("Open...", {width, 0})) open_robots(context);
  context.log.item("open");
  tooltip("robots from files or a folder (Ctrl O); or drop them on the window");
  ImGui::SameLine();
  ImGui::BeginDisabled(scene.entries().empty());
  if (ImGui::Button(selection.empty() ? "Save all..." : "Save...", {width, 0})) save_robots(context);
  context.log.item("save");
  tooltip("the selected robots, or all where none is selected (Ctrl S)");
  ImGui::SameLine();
  if (ImGui::Button("Clear", {width, 0})) scene.clear();
  context.log.item("clear");
  tooltip("remove all robots; Ctrl Z brings them back");
  ImGui::EndDisabled();
}

void RobotsPanel::mutate(PanelContext& context) {
  if (context.scene.selection().empty()) {
    context.toasts.show(Tone::info, "select the robots to mutate first");
    return;
  }
  context.scene.mutate(context.scene.selection(), mutation_);
  ++mutation_.seed;
}

}  // namespace mercury::window
