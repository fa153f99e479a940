// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/panels.h"

#include <fmt/format.h>
#include <imgui.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "app/window/panels/help_panel.h"
#include "app/window/panels/play_bar.h"
#include "app/window/panels/see_panel.h"
#include "app/window/panels/tune_panel.h"
#include "app/window/toolkit/theme.h"
#include "app/window/toolkit/widgets.h"

namespace mercury::window {
namespace {

void draw_see(Desk& desk) {
  ViewSettings view = desk.scene.view();
  if (draw_see_panel(view, desk.camera, desk.preferences, desk.scene.configuration().environment,
                     desk.scene.entries().size(), desk.observations))
    desk.scene.set_view(view);
}

void copy_as_command(Desk& desk, const char* subcommand) {
  CommandText command;
  as_seen(desk, [&] { command = desk.scene.command(subcommand); });
  ImGui::SetClipboardText(command.text.c_str());
  desk.observations.tell("copied", {{"text", command.text}});
  desk.toasts.say(Tone::success, "copied: " + command.text);
  for (const std::string& line : command.notes) desk.toasts.say(Tone::warning, line);
}

void draw_tune(Desk& desk, MaterialsPanel& materials) {
  Configuration configuration = desk.scene.configuration();
  if (draw_physics_sliders(configuration, desk.observations)) desk.scene.set_configuration(configuration);
  ImGui::SameLine();
  if (ImGui::Button("Copy as command")) copy_as_command(desk, "view");
  desk.observations.item("tune.copy");
  hint("the line for a terminal that makes this scene");
  materials.draw(desk);
  // One edit, to be taken back at once, ends where the mouse lets go.
  if (ImGui::IsMouseReleased(0)) desk.scene.end_edit();
}

}  // namespace

Panels::Panels(Desk& desk, Window& window, PictureView& picture)
    : desk_(desk), window_(window), picture_(picture), browser_(window.context()),
      left_("##left", false,
            {{"Robots", "the robots of the scene", [this] { robots_.draw(desk_, aspect_); }},
             {"Browser", "folders of robots, as pictures", [this] { browser_.draw(desk_); }},
             {"Ranking", "who went farthest", [this] { ranking_.draw(desk_, aspect_); }}}),
      right_("##right", true,
             {{"See", "colours, arrows, camera, looks", [this] { draw_see(desk_); }},
              {"Tune", "solver, environment, materials", [this] { draw_tune(desk_, materials_); }},
              {"Measure", "plots over time", [this] { measure_.draw(desk_); }},
              {"Film", "videos and pictures", [this] { film_.draw(desk_, [this] { screenshot_wanted_ = true; }); }},
              {"Stats", "where the computer's time goes", [this] {
                 performance_.draw(desk_.scene.moment(), picture_, desk_.scene.device_name(),
                                   window_.context().describe());
               }}}) {}

PictureArea Panels::draw_frame() {
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  PictureArea area{{0, 0}, screen};
  if (desk_.preferences.panels) {
    draw_menu();
    const float top = ImGui::GetFrameHeight(),
                bar = 1.15f * ImGui::GetFrameHeight() + 2 * ImGui::GetStyle().WindowPadding.y;
    area = {{Column::pixels(desk_.preferences.left_width), top},
            {screen.x - Column::pixels(desk_.preferences.right_width), screen.y - bar}};
    left_.draw(desk_, top, area.high.y, desk_.preferences.left_panel, desk_.preferences.left_width);
    right_.draw(desk_, top, area.high.y, desk_.preferences.right_panel, desk_.preferences.right_width);
    draw_play_bar(desk_, {0, area.high.y}, screen);
  }
  aspect_ = area.aspect();
  desk_.observations.item("picture", area.low, area.high);
  return area;
}

void Panels::draw_over(const PictureArea& area, const render::Camera& camera, double dt) {
  explosions_.follow(desk_, area, camera);
  explosions_.draw(desk_, area);
  if (help_) draw_help(help_, desk_.observations);
  desk_.dialogs.draw(desk_.observations);
  desk_.toasts.draw(area.low, area.high, dt, desk_.observations);
}

void Panels::work(double seconds) { browser_.work(seconds, desk_.scene.view().theme); }

void Panels::show(const std::string& panel) {
  desk_.preferences.panels = true;
  (left_.has(panel) ? desk_.preferences.left_panel : desk_.preferences.right_panel) = panel;
  desk_.observations.tell("panel", {{"name", panel}});
}

void Panels::menu_item(const char* name, Action action, bool enabled, bool checked) {
  const char* keys = "";
  for (const Binding& binding : bindings())
    if (binding.action == action) keys = binding.keys;
  if (ImGui::MenuItem(name, keys, checked, enabled)) carry_out({action});
}

void Panels::draw_menu() {
  if (!ImGui::BeginMainMenuBar()) return;
  LiveScene& scene = desk_.scene;
  const bool robots = !scene.entries().empty(), selected = !scene.selection().empty();
  if (ImGui::BeginMenu("File")) {
    menu_item("Open...", Action::open);
    menu_item(selected ? "Save selected..." : "Save all...", Action::save, robots);
    menu_item("Picture of the window", Action::screenshot);
    if (ImGui::MenuItem("Copy as command")) copy_as_command(desk_, "view");
    if (ImGui::MenuItem("Copy as command for a video")) copy_as_command(desk_, "render");
    ImGui::Separator();
    menu_item("Quit", Action::quit);
    ImGui::EndMenu();
  }
  desk_.observations.item("menu.File");
  if (ImGui::BeginMenu("Edit")) {
    menu_item(fmt::format("Undo {}", scene.undo_name()).c_str(), Action::undo, scene.can_undo());
    menu_item(fmt::format("Redo {}", scene.redo_name()).c_str(), Action::redo, scene.can_redo());
    ImGui::Separator();
    menu_item("New random robots", Action::new_random);
    menu_item("Duplicate", Action::duplicate, selected);
    menu_item("Mutate", Action::mutate, selected);
    menu_item("Remove", Action::remove, selected);
    menu_item("Select all", Action::select_all, robots);
    ImGui::EndMenu();
  }
  desk_.observations.item("menu.Edit");
  if (ImGui::BeginMenu("View")) {
    for (const Column* column : {&left_, &right_})
      for (const Panel& panel : column->panels())
        if (ImGui::MenuItem(panel.name, panel.meaning)) show(panel.name);
    ImGui::Separator();
    menu_item("Frame", Action::frame, robots);
    menu_item("Drag arrows", Action::drag_arrows, true, scene.view().shown.arrows.drag);
    menu_item("Dark or light", Action::theme);
    menu_item("Hide panels", Action::hide_panels);
    menu_item("Full screen", Action::full_screen);
    ImGui::EndMenu();
  }
  desk_.observations.item("menu.View");
  if (ImGui::BeginMenu("Help")) {
    menu_item("Keys and mouse", Action::help);
    ImGui::EndMenu();
  }
  desk_.observations.item("menu.Help");
  const std::string edit = "F1: all keys";
  ImGui::SameLine(ImGui::GetIO().DisplaySize.x - ImGui::CalcTextSize(edit.c_str()).x - ImGui::GetFontSize());
  ImGui::PushStyleColor(ImGuiCol_Text, palette().faint);
  ImGui::TextUnformatted(edit.c_str());
  ImGui::PopStyleColor();
  ImGui::EndMainMenuBar();
}

}  // namespace mercury::window
