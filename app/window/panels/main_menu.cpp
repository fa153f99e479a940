// SPDX-License-Identifier: Apache-2.0
// The part of Panels that draws the menu bar.
#include <fmt/format.h>
#include <imgui.h>

#include "app/live/scene_comparison.h"
#include "app/live/scene_mouse.h"
#include "app/live/scene_robots.h"
#include "app/live/scene_selection.h"
#include "app/window/panels/commands.h"
#include "app/window/panels/panels.h"
#include "app/window/toolkit/theme.h"

namespace mercury::window {

void Panels::menu_item(const char* name, Action action, bool enabled, bool checked) {
  if (ImGui::MenuItem(name, context_.keys.keys_of(action).c_str(), checked, enabled)) execute(action);
}

void Panels::draw_menu() {
  if (!ImGui::BeginMainMenuBar()) return;
  draw_file_menu();
  draw_edit_menu();
  draw_view_menu();
  if (ImGui::BeginMenu("Help")) {
    menu_item("Search everything...", Action::palette);
    menu_item("Keys and mouse", Action::help);
    if (ImGui::MenuItem("Change keys...")) show_keys_file();
    context_.log.item("menu.keys");
    menu_item("Messages", Action::messages);
    context_.log.item("menu.messages");
    ImGui::EndMenu();
  }
  context_.log.item("menu.Help");
  const ImVec2 left = ImGui::GetCursorScreenPos();
  const float right = draw_menu_hint();
  context_.toasts.draw({left.x, left.y + ImGui::GetStyle().FramePadding.y}, right, context_.log);
  ImGui::EndMainMenuBar();
}

// At the right end, if there is room. Returns where it begins [pixels].
float Panels::draw_menu_hint() {
  const std::string keys = context_.keys.keys_of(Action::help), text = keys.substr(0, keys.find(' ')) + ": all keys";
  const float left = ImGui::GetIO().DisplaySize.x - ImGui::CalcTextSize(text.c_str()).x - ImGui::GetFontSize();
  if (keys.empty() || left < ImGui::GetCursorPosX()) return ImGui::GetIO().DisplaySize.x;
  ImGui::SameLine(left);
  ImGui::PushStyleColor(ImGuiCol_Text, palette().faint);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopStyleColor();
  return left;
}

// The settings file of keys, which lists all commands until the user changes it.
void Panels::show_keys_file() {
  const std::filesystem::path file = settings_folder() / "keys.txt";
  if (settings_folder().empty() || !write_keys_template(file))
    context_.toasts.show(Tone::error, fmt::format("{}: cannot be written", file.string()));
  else
    context_.toasts.show(Tone::info, fmt::format("edit {}; the window reads it when it opens", file.string()));
}

void Panels::draw_file_menu() {
  if (ImGui::BeginMenu("File")) {
    const LiveScene& scene = context_.scene;
    menu_item("Open...", Action::open);
    if (ImGui::MenuItem("Open a run...")) choose_run(context_);
    menu_item("Save the scene...", Action::save_scene, scene.robots().count() > 0);
    menu_item(scene.selection().robots().empty() ? "Save all robots..." : "Save selected robots...", Action::save,
              scene.robots().count() > 0);
    const bool robots = scene.robots().count() > 0;
    if (ImGui::MenuItem("Export the pose...", nullptr, false, robots)) export_pose(context_);
    context_.log.item("menu.export_pose");
    if (ImGui::MenuItem("Export the motion...", nullptr, false, robots)) export_motion(context_);
    context_.log.item("menu.export_motion");
    if (ImGui::MenuItem("Export the run...", nullptr, false, context_.run.is_open())) export_run(context_);
    context_.log.item("menu.export_run");
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
    const bool selected = !scene.selection().robots().empty();
    menu_item(fmt::format("Undo {}", scene.history().undo_name()).c_str(), Action::undo, scene.history().can_undo());
    menu_item(fmt::format("Redo {}", scene.history().redo_name()).c_str(), Action::redo, scene.history().can_redo());
    ImGui::Separator();
    menu_item("New random robots", Action::new_random);
    menu_item("Duplicate", Action::duplicate, selected);
    menu_item("Rename...", Action::rename, selected);
    menu_item("Edit the body", Action::edit_body, selected, context_.body_edit.robot != 0);
    menu_item("Mutate", Action::mutate, selected);
    menu_item("Breed from two", Action::breed, scene.selection().robots().size() == 2);
    menu_item("Evolve...", Action::evolve, scene.robots().count() > 0);
    menu_item("Remove", Action::remove, selected);
    menu_item("Keep only the selected", Action::keep_selected, selected);
    menu_item("Keep the best...", Action::keep_best, scene.robots().count() > 1);
    menu_item("Remove pins and springs", Action::detach, scene.mouse().has_attachments(selected_or_all(scene)));
    ImGui::Separator();
    menu_item("Select all", Action::select_all, scene.robots().count() > 0);
    menu_item("Invert the selection", Action::invert_selection, scene.robots().count() > 0);
    ImGui::EndMenu();
  }
  context_.log.item("menu.Edit");
}

void Panels::draw_view_menu() {
  if (ImGui::BeginMenu("View")) {
    for (const PanelEntry& panel : panel_table())
      if (ImGui::MenuItem(panel.title, panel.tooltip)) show(panel.title);
    ImGui::Separator();
    menu_item("Frame", Action::frame, context_.scene.robots().count() > 0);
    menu_item("Drag arrows", Action::drag_arrows, true, context_.scene.view().shown.arrows.drag);
    const ArrowKinds& arrows = context_.scene.view().shown.arrows;
    menu_item("Contact arrows", Action::contact_arrows, true, arrows.contact);
    menu_item("Force arrows", Action::force_arrows, true, arrows.force);
    menu_item("Dark or light", Action::theme);
    menu_item("Two views", Action::compare, context_.scene.robots().count() > 0,
              context_.scene.comparison().second().has_value());
    menu_item("Ghosts of the selected", Action::ghosts,
              !context_.scene.selection().robots().empty() || !context_.scene.comparison().ghosts().empty(),
              !context_.scene.comparison().ghosts().empty());
    menu_item("Left panels", Action::left_panels, true, column_open(Side::left));
    menu_item("Right panels", Action::right_panels, true, column_open(Side::right));
    menu_item("Hide panels", Action::hide_panels);
    menu_item("Larger text", Action::larger_text);
    menu_item("Smaller text", Action::smaller_text);
    menu_item("Full screen", Action::full_screen);
    ImGui::EndMenu();
  }
  context_.log.item("menu.View");
}

}  // namespace mercury::window
