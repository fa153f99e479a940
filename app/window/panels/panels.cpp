// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/panels.h"

#include <fmt/format.h>
#include <imgui.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "app/window/panels/help_panel.h"
#include "app/window/panels/play_bar.h"
#include "app/window/panels/tune_panel.h"
#include "app/window/panels/view_panel.h"
#include "app/window/toolkit/theme.h"
#include "app/window/toolkit/widgets.h"

namespace mercury::window {
namespace {

void draw_view(PanelContext& context) {
  ViewSettings view = context.scene.view();
  if (draw_view_panel(view, context.camera, context.preferences, context.scene.configuration().environment,
                      context.scene.entries().size(), context.log))
    context.scene.set_view(view);
}

void copy_as_command(PanelContext& context, const char* subcommand) {
  CommandText command;
  with_window_camera(context, [&] { command = context.scene.command(subcommand); });
  ImGui::SetClipboardText(command.text.c_str());
  context.log.write("copied", {{"text", command.text}});
  context.toasts.show(Tone::success, "copied: " + command.text);
  for (const std::string& line : command.notes) context.toasts.show(Tone::warning, line);
}

void draw_tune(PanelContext& context, MaterialsPanel& materials) {
  Configuration configuration = context.scene.configuration();
  if (draw_physics_sliders(configuration, context.log)) context.scene.set_configuration(configuration);
  ImGui::SameLine();
  if (ImGui::Button("Copy as command")) copy_as_command(context, "view");
  context.log.item("tune.copy");
  tooltip("the line for a terminal that makes this scene");
  materials.draw(context);
  // One edit, to be taken back at once, ends where the mouse lets go.
  if (ImGui::IsMouseReleased(0)) context.scene.end_edit();
}

}  // namespace

Panels::Panels(PanelContext& context, Window& window, Viewport& picture)
    : context_(context), window_(window), picture_(picture), browser_(window.gl_context()),
      left_("##left", false,
            {{"Robots", "the robots of the scene", [this] { robots_.draw(context_, aspect_); }},
             {"Browser", "folders of robots, as pictures", [this] { browser_.draw(context_); }},
             {"Ranking", "who went farthest", [this] { ranking_.draw(context_, aspect_); }}}),
      right_(
          "##right", true,
          {{"View", "colours, arrows, camera, looks", [this] { draw_view(context_); }},
           {"Tune", "solver, environment, materials", [this] { draw_tune(context_, materials_); }},
           {"Measure", "plots over time", [this] { measure_.draw(context_); }},
           {"Video", "videos and pictures", [this] { film_.draw(context_, [this] { screenshot_requested_ = true; }); }},
           {"Stats", "where the computer's time goes", [this] {
              performance_.draw(context_.scene.snapshot(), picture_, context_.scene.device_name(),
                                window_.gl_context().describe());
            }}}) {}

ViewportArea Panels::draw_frame() {
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  ViewportArea area{{0, 0}, screen};
  if (context_.preferences.panels) {
    draw_menu();
    const float top = ImGui::GetFrameHeight(),
                bar = 1.15f * ImGui::GetFrameHeight() + 2 * ImGui::GetStyle().WindowPadding.y;
    area = {{PanelColumn::pixels(context_.preferences.left_width), top},
            {screen.x - PanelColumn::pixels(context_.preferences.right_width), screen.y - bar}};
    left_.draw(context_, top, area.high.y, context_.preferences.left_panel, context_.preferences.left_width);
    right_.draw(context_, top, area.high.y, context_.preferences.right_panel, context_.preferences.right_width);
    draw_play_bar(context_, {0, area.high.y}, screen);
  }
  aspect_ = area.aspect();
  context_.log.item("picture", area.low, area.high);
  return area;
}

void Panels::draw_over(const ViewportArea& area, const render::Camera& camera, double dt) {
  explosions_.follow(context_, area, camera);
  explosions_.draw(context_, area);
  if (help_) draw_help(help_, context_.log);
  context_.dialogs.draw(context_.log);
  context_.toasts.draw(area.low, area.high, dt, context_.log);
}

void Panels::work(double seconds) { browser_.work(seconds, context_.scene.view().theme); }

void Panels::show(const std::string& panel) {
  context_.preferences.panels = true;
  (left_.has(panel) ? context_.preferences.left_panel : context_.preferences.right_panel) = panel;
  context_.log.write("panel", {{"name", panel}});
}

void Panels::menu_item(const char* name, Action action, bool enabled, bool checked) {
  const char* keys = "";
  for (const KeyBinding& binding : key_bindings())
    if (binding.action == action) keys = binding.keys;
  if (ImGui::MenuItem(name, keys, checked, enabled)) execute({action});
}

void Panels::draw_menu() {
  if (!ImGui::BeginMainMenuBar()) return;
  LiveScene& scene = context_.scene;
  const bool robots = !scene.entries().empty(), selected = !scene.selection().empty();
  if (ImGui::BeginMenu("File")) {
    menu_item("Open...", Action::open);
    menu_item(selected ? "Save selected..." : "Save all...", Action::save, robots);
    menu_item("Picture of the window", Action::screenshot);
    if (ImGui::MenuItem("Copy as command")) copy_as_command(context_, "view");
    if (ImGui::MenuItem("Copy as command for a video")) copy_as_command(context_, "render");
    ImGui::Separator();
    menu_item("Quit", Action::quit);
    ImGui::EndMenu();
  }
  context_.log.item("menu.File");
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
  context_.log.item("menu.Edit");
  if (ImGui::BeginMenu("View")) {
    for (const PanelColumn* column : {&left_, &right_})
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
  context_.log.item("menu.View");
  if (ImGui::BeginMenu("Help")) {
    menu_item("Keys and mouse", Action::help);
    ImGui::EndMenu();
  }
  context_.log.item("menu.Help");
  const std::string edit = "F1: all keys";
  ImGui::SameLine(ImGui::GetIO().DisplaySize.x - ImGui::CalcTextSize(edit.c_str()).x - ImGui::GetFontSize());
  ImGui::PushStyleColor(ImGuiCol_Text, palette().faint);
  ImGui::TextUnformatted(edit.c_str());
  ImGui::PopStyleColor();
  ImGui::EndMainMenuBar();
}

}  // namespace mercury::window
