// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/robot_menu.h"

#include <fmt/format.h>

#include "app/window/panels/export_commands.h"
#include "app/window/panels/robot_commands.h"
#include "app/window/toolkit/theme.h"

namespace mercury::window {
namespace {

constexpr const char* id = "##robotmenu";

void request(PanelContext& context, RobotId robot, std::optional<Hit> hit) {
  if (!context.scene.is_selected(robot)) context.scene.select(robot);
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
    if (items.item("Pin this mass")) scene.pin(*hit);
    ImGui::Separator();
  }
  if (scene.has_attachments(selection)) {
    items.command("Remove pins and springs", Action::detach);
    ImGui::Separator();
  }
}

}  // namespace

void robot_menu_of_row(PanelContext& context, RobotId robot) {
  if (ImGui::IsItemHovered() && ImGui::IsMouseClicked(1)) request(context, robot, std::nullopt);
}

void open_robot_menu(PanelContext& context, const Hit& hit) { request(context, hit.robot, hit); }

void draw_robot_menu(PanelContext& context, const std::function<void(Action)>& execute) {
  RobotMenu& menu = context.robot_menu;
  if (std::exchange(menu.requested, false)) ImGui::OpenPopup(id);
  if (!ImGui::BeginPopup(id)) return;
  LiveScene& scene = context.scene;
  const std::vector<RobotId> selection = scene.selection();
  const Items items{context, execute};
  const bool one = selection.size() == 1, hidden = scene.is_hidden(menu.robot);
  ImGui::PushStyleColor(ImGuiCol_Text, palette().faint);
  ImGui::TextUnformatted(one ? name_of_robot(scene, selection.front()).c_str()
                             : fmt::format("{} robots", selection.size()).c_str());
  ImGui::PopStyleColor();
  ImGui::Separator();
  draw_mass_items(items, context, selection);
  items.command("Frame", Action::frame);
  items.command("Follow", Action::follow, one);
  if (items.item(hidden ? "Show" : "Hide"))
    for (const RobotId robot : selection) scene.set_hidden(robot, !hidden);
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
