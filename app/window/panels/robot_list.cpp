// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/robot_list.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "app/live/picking.h"
#include "app/live/scene_mouse.h"
#include "app/live/scene_robots.h"
#include "app/live/scene_selection.h"
#include "app/window/panels/commands.h"
#include "app/window/toolkit/theme.h"
#include "app/window/toolkit/widgets.h"

namespace mercury::window {
namespace {

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

constexpr std::size_t searchable = 8;  // robots from which on a field to search them is shown

constexpr const char* id = "##robotmenu";

void request(PanelContext& context, RobotId robot, std::optional<Hit> hit) {
  if (!context.scene.selection().contains(robot)) context.scene.selection().select(robot);
  context.robot_menu = {.requested = true, .robot = robot, .hit = std::move(hit)};
}

struct Items {
  PanelContext& context;
  const std::function<void(Action)>& execute;

  void command(const char* name, Action action, bool enabled = true) const {
    if (ImGui::MenuItem(name, context.keys.keys_of(action).c_str(), false, enabled)) execute(action);
    context.log.item(fmt::format("robot_menu.{}", name));
  }
  bool item(const char* name, bool enabled = true) const {
    const bool chosen = ImGui::MenuItem(name, nullptr, false, enabled);
    context.log.item(fmt::format("robot_menu.{}", name));
    return chosen;
  }
};

void draw_mass_items(const Items& items, PanelContext& context, const std::vector<RobotId>& selection) {
  LiveScene& scene = context.scene;
  if (const std::optional<Hit>& hit = context.robot_menu.hit) {
    if (items.item("Pin this mass")) scene.mouse().pin(*hit);
    ImGui::Separator();
  }
  if (scene.mouse().has_attachments(selection)) {
    items.command("Remove pins and springs", Action::detach);
    ImGui::Separator();
  }
}

}  // namespace

void RowSelection::click(LiveScene& scene, RobotId robot, std::span<const RobotId> rows) {
  const ImGuiIO& io = ImGui::GetIO();
  auto first = std::ranges::find(rows, anchor_), last = std::ranges::find(rows, robot);
  if (io.KeyShift && first != rows.end() && last != rows.end()) {
    if (last < first) std::swap(first, last);
    std::vector<RobotId> selected = io.KeyCtrl ? scene.selection().robots() : std::vector<RobotId>{};
    selected.insert(selected.end(), first, last + 1);
    scene.selection().set(selected);
    return;
  }
  if (io.KeyCtrl)
    scene.selection().toggle(robot);
  else
    scene.selection().select(robot);
  anchor_ = robot;
}

void RobotList::draw(PanelContext& context, float room) {
  std::vector<RobotEntry> all = context.scene.robots().entries();
  const auto selected = std::ranges::count_if(all, &RobotEntry::selected);
  const std::size_t count = all.size();
  heading(
      fmt::format("{} robot{}{}", count, count == 1 ? "" : "s", selected ? fmt::format(", {} selected", selected) : "")
          .c_str());
  const bool search = count >= searchable || !search_.empty();
  if (search) {
    ImGui::SetNextItemWidth(-1);
    text_field("##search", search_, "search");
    context.log.item("robots.search");
  }
  const std::vector<RobotEntry> entries = listed(std::move(all));
  if (!search_.empty()) note(fmt::format("{} of {}", entries.size(), count).c_str());
  // As many whole rows as fit, and the heading.
  const float line = ImGui::GetTextLineHeight() + 2 * ImGui::GetStyle().CellPadding.y;
  const float used = (search ? 2.0f : 1.0f) * ImGui::GetFrameHeightWithSpacing();
  const float most = std::max(5.0f, std::floor((room - used) / line) - 1);
  draw_table(context, entries, (std::clamp(static_cast<float>(entries.size()), 3.0f, most) + 1) * line + 2);
}

// The robots whose names fit the search, in the order of the column that was clicked.
std::vector<RobotEntry> RobotList::listed(std::vector<RobotEntry> entries) const {
  std::erase_if(entries, [&](const RobotEntry& entry) { return !fuzzy_match(search_, entry.name); });
  if (column_ == 0) std::ranges::stable_sort(entries, {}, &RobotEntry::name);
  if (column_ == 1) std::ranges::stable_sort(entries, {}, &RobotEntry::springs);
  if (!ascending_ && column_ >= 0) std::ranges::reverse(entries);
  return entries;
}

void RobotList::draw_table(PanelContext& context, const std::vector<RobotEntry>& entries, float height) {
  if (!ImGui::BeginTable("list", 3,
                         ImGuiTableFlags_ScrollY | ImGuiTableFlags_RowBg | ImGuiTableFlags_BordersOuter |
                             ImGuiTableFlags_Sortable | ImGuiTableFlags_SortTristate,
                         {0, height}))
    return;
  ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthStretch);
  ImGui::TableSetupColumn("springs", ImGuiTableColumnFlags_WidthFixed | ImGuiTableColumnFlags_PreferSortDescending);
  ImGui::TableSetupColumn("shown", ImGuiTableColumnFlags_WidthFixed | ImGuiTableColumnFlags_NoSort);
  ImGui::TableSetupScrollFreeze(0, 1);
  ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
  for (int column = 0; column < 3; ++column) {
    if (!ImGui::TableSetColumnIndex(column)) continue;
    ImGui::TableHeader(ImGui::TableGetColumnName(column));
    context.log.item(fmt::format("robots.by.{}", ImGui::TableGetColumnName(column)));
  }
  if (const ImGuiTableSortSpecs* specs = ImGui::TableGetSortSpecs()) {
    column_ = specs->SpecsCount > 0 ? specs->Specs[0].ColumnIndex : -1;
    ascending_ = specs->SpecsCount == 0 || specs->Specs[0].SortDirection == ImGuiSortDirection_Ascending;
  }
  order_.clear();
  for (const RobotEntry& entry : entries) order_.push_back(entry.id);
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(entries.size()));
  while (clipper.Step())
    for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
      const RobotEntry& entry = entries[static_cast<std::size_t>(i)];
      ImGui::PushID(static_cast<int>(entry.id));
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      draw_row(context, entry, i);
      ImGui::PopID();
    }
  ImGui::EndTable();
}

void RobotList::draw_row(PanelContext& context, const RobotEntry& entry, int index) {
  if (entry.selected) ImGui::TableSetBgColor(ImGuiTableBgTarget_RowBg1, ImGui::GetColorU32(ImGuiCol_Header));
  const bool changed = entry.unsaved && (entry.tuned || !entry.file.empty());
  if (entry.exploded) ImGui::PushStyleColor(ImGuiCol_Text, palette().bad);
  const std::string name = shortened(entry.name + (changed ? " *" : ""), ImGui::GetContentRegionAvail().x);
  if (entry.selected)
    ImGui::PushStyleColor(ImGuiCol_Header, IM_COL32_BLACK_TRANS);  // the whole row has the color already
  const bool clicked = ImGui::Selectable(name.c_str(), entry.selected, ImGuiSelectableFlags_AllowDoubleClick);
  if (entry.selected) ImGui::PopStyleColor();
  if (clicked && ImGui::IsMouseDoubleClicked(0))
    frame_robots(context, {entry.id});
  else if (clicked)
    selection_.click(context.scene, entry.id, order_);
  if (entry.exploded) ImGui::PopStyleColor();
  if (index < 100) context.log.item(fmt::format("robot.{}", index));
  robot_menu_of_row(context, entry.id);
  if (ImGui::IsItemHovered() && pointer_rests()) show_details(entry);
  ImGui::TableNextColumn();
  ImGui::PushStyleColor(ImGuiCol_Text, palette().faint);
  right_aligned(fmt::format("{}", entry.springs));
  ImGui::PopStyleColor();
  ImGui::TableNextColumn();
  bool shown = !entry.hidden;
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {ImGui::GetStyle().FramePadding.x, 0});
  if (ImGui::Checkbox("##shown", &shown)) context.scene.selection().set_hidden(entry.id, !shown);
  ImGui::PopStyleVar();
  tooltip("draw this robot; physics goes on either way");
}

void robot_menu_of_row(PanelContext& context, RobotId robot) {
  if (ImGui::IsItemHovered() && ImGui::IsMouseClicked(1)) request(context, robot, std::nullopt);
}

void open_robot_menu(PanelContext& context, const Hit& hit) { request(context, hit.robot, hit); }

void draw_robot_menu(PanelContext& context, const std::function<void(Action)>& execute) {
  RobotMenu& menu = context.robot_menu;
  if (std::exchange(menu.requested, false)) ImGui::OpenPopup(id);
  if (!ImGui::BeginPopup(id)) return;
  LiveScene& scene = context.scene;
  const std::vector<RobotId> selection = scene.selection().robots();
  const Items items{context, execute};
  const bool one = selection.size() == 1, hidden = scene.selection().is_hidden(menu.robot);
  ImGui::PushStyleColor(ImGuiCol_Text, palette().faint);
  ImGui::TextUnformatted(one ? name_of_robot(scene, selection.front()).c_str()
                             : fmt::format("{} robots", selection.size()).c_str());
  ImGui::PopStyleColor();
  ImGui::Separator();
  draw_mass_items(items, context, selection);
  items.command("Frame", Action::frame);
  items.command("Follow", Action::follow, one);
  if (items.item(hidden ? "Show" : "Hide"))
    for (const RobotId robot : selection) scene.selection().set_hidden(robot, !hidden);
  ImGui::Separator();
  items.command("Rename...", Action::rename, one);
  items.command("Edit the body", Action::edit_body, one);
  items.command("Duplicate", Action::duplicate);
  items.command("Mutate", Action::mutate);
  items.command("Breed from these two", Action::breed, selection.size() == 2);
  items.command("Evolve...", Action::evolve);
  ImGui::Separator();
  items.command("Save...", Action::save);
  if (items.item("Export the pose...", one)) export_pose(context);
  ImGui::Separator();
  items.command("Remove", Action::remove);
  items.command("Keep only these", Action::keep_selected);
  ImGui::EndPopup();
}

}  // namespace mercury::window
