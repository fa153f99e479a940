// SPDX-License-Identifier: Apache-2.0
// The part of Panels that draws the menu bar.
#include <fmt/format.h>
#include <imgui.h>

#include "app/window/panels/evolution_commands.h"
#include "app/window/panels/export_commands.h"
#include "app/window/panels/panels.h"
#include "app/window/panels/scene_commands.h"
#include "app/window/toolkit/theme.h"

namespace mercury::window {

void Panels::menu_item(const char* name, Action action, bool enabled, bool checked) {
  const char* keys = "";
  for (const KeyBinding& binding : key_bindings())
    if (binding.action == action) keys = binding.keys;
  if (ImGui::MenuItem(name, keys, checked, enabled)) execute({action});
}

void Panels::draw_menu() {
  if (!ImGui::BeginMainMenuBar()) return;
  draw_file_menu();
  draw_edit_menu();
  draw_view_menu();
  if (ImGui::BeginMenu("Help")) {
    menu_item("Keys and mouse", Action::help);
    ImGui::EndMenu();
  }
  context_.log.item("menu.Help");
  const char* text = "F1: all keys";
  ImGui::SameLine(ImGui::GetIO().DisplaySize.x - ImGui::CalcTextSize(text).x - ImGui::GetFontSize());
  ImGui::PushStyleColor(ImGuiCol_Text, palette().faint);
  ImGui::TextUnformatted(text);
  ImGui::PopStyleColor();
  ImGui::EndMainMenuBar();
}

void Panels::draw_file_menu() {
  if (ImGui::BeginMenu("File")) {
    const LiveScene& scene = context_.scene;
    menu_item("Open...", Action::open);
    if (ImGui::MenuItem("Open a run...")) choose_run(context_);
    menu_item("Save the scene...", Action::save_scene, !scene.entries().empty());
    menu_item(scene.selection().empty() ? "Save all robots..." : "Save selected robots...", Action::save,
              !scene.entries().empty());
    const bool robots = !scene.entries().empty();
    if (ImGui::MenuItem("Export the pose...", nullptr, false, robots)) export_pose(context_);
    context_.log.item("menu.export_pose");
    if (ImGui::MenuItem("Export the motion...", nullptr, false, robots)) export_motion(context_);
    context_.log.item("menu.export_motion");
    menu_item("Save a screenshot", Action::screenshot);
    if (ImGui::MenuItem("Copy as command")) copy_as_command(context_, "view");
    if (ImGui::MenuItem("Copy as command for a video")) copy_as_command(context_, "render");
    ImGui::Separator();
    menu_item("Quit", Action::quit);
    ImGui::EndMenu();
  }
  context_.log.item("menu.File");
}

void Panels::draw_edit_menu() {
  if (ImGui::BeginMenu("Edit")) {
    const LiveScene& scene = context_.scene;
    const bool selected = !scene.selection().empty();
    menu_item(fmt::format("Undo {}", scene.undo_name()).c_str(), Action::undo, scene.can_undo());
    menu_item(fmt::format("Redo {}", scene.redo_name()).c_str(), Action::redo, scene.can_redo());
    ImGui::Separator();
    menu_item("New random robots", Action::new_random);
    menu_item("Duplicate", Action::duplicate, selected);
    menu_item("Mutate", Action::mutate, selected);
    menu_item("Evolve...", Action::evolve, selected);
    menu_item("Remove", Action::remove, selected);
    menu_item("Select all", Action::select_all, !scene.entries().empty());
    ImGui::EndMenu();
  }
  context_.log.item("menu.Edit");
}

void Panels::draw_view_menu() {
  if (ImGui::BeginMenu("View")) {
    for (const PanelEntry& panel : panel_table())
      if (ImGui::MenuItem(panel.title, panel.tooltip)) show(panel.title);
    ImGui::Separator();
    menu_item("Frame", Action::frame, !context_.scene.entries().empty());
    menu_item("Drag arrows", Action::drag_arrows, true, context_.scene.view().shown.arrows.drag);
    menu_item("Dark or light", Action::theme);
    menu_item("Hide panels", Action::hide_panels);
    menu_item("Full screen", Action::full_screen);
    ImGui::EndMenu();
  }
  context_.log.item("menu.View");
}

}  // namespace mercury::window
