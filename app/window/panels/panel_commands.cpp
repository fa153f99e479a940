// SPDX-License-Identifier: Apache-2.0
// What keys and menus do.
#include <fmt/format.h>
#include <imgui.h>

#include <nlohmann/json.hpp>

#include "app/window/panels/panels.h"
#include "app/window/panels/see_panel.h"
#include "app/window/picture/robot_files.h"

namespace mercury::window {

void Panels::carry_out(const Command& command) {
  LiveScene& scene = desk_.scene;
  const std::vector<RobotId> selection = scene.selection();
  switch (command.action) {
    case Action::play_pause:
      scene.toggle();
      break;
    case Action::step:
      scene.step();
      break;
    case Action::faster:
      scene.change_speed(1);
      break;
    case Action::slower:
      scene.change_speed(-1);
      break;
    case Action::real_time:
      scene.set_speed(1);
      break;
    case Action::as_fast_as_it_goes:
      scene.set_speed(scene.speed() == unlimited_speed ? 1 : unlimited_speed);
      break;
    case Action::reset:
      scene.reset();
      break;
    case Action::new_random:
      robots_.random.generate(desk_);
      break;
    case Action::duplicate:
      scene.duplicate(selection);
      break;
    case Action::remove:
      scene.remove(selection);
      break;
    case Action::mutate:
      robots_.mutate(desk_);
      break;
    case Action::select_all:
      scene.select_all();
      break;
    case Action::deselect:
      escape();
      break;
    case Action::undo:
      if (scene.can_undo()) desk_.toasts.say(Tone::news, "undone: " + scene.undo_name());
      scene.undo();
      break;
    case Action::redo:
      if (scene.can_redo()) desk_.toasts.say(Tone::news, "done again: " + scene.redo_name());
      scene.redo();
      break;
    case Action::open:
      open_robots(desk_);
      break;
    case Action::save:
      save_robots(desk_);
      break;
    case Action::frame:
    case Action::follow:
    case Action::turntable:
    case Action::top_view:
      change_camera(command.action);
      break;
    case Action::drag_arrows:
    case Action::color:
    case Action::springs:
    case Action::labels:
    case Action::legend:
    case Action::theme:
      change_view(command.action, command.number);
      break;
    case Action::hide_panels:
      desk_.preferences.panels = !desk_.preferences.panels;
      break;
    case Action::full_screen:
      window_.toggle_full_screen();
      break;
    case Action::screenshot:
      screenshot_wanted_ = true;
      break;
    case Action::record:
      film_.toggle(desk_);
      break;
    case Action::help:
      help_ = !help_;
      break;
    case Action::quit:
      quit();
      break;
  }
}

void Panels::change_view(Action action, int number) {
  ViewSettings view = desk_.scene.view();
  const Environment& environment = desk_.scene.configuration().environment;
  const bool ocean = std::holds_alternative<Ocean>(environment);
  switch (action) {
    case Action::drag_arrows:
      toggle_drag_arrows(view);
      if (view.shown.arrows.drag && !ocean) desk_.toasts.say(Tone::news, "drag arrows are there in the ocean only");
      desk_.observations.tell("view", {{"drag", view.shown.arrows.drag}});
      break;
    case Action::color:
      if (!color_by_number(view, number, environment)) return;
      desk_.toasts.say(Tone::news, fmt::format("coloured by {}", name_of(view.color)));
      break;
    case Action::springs:
      view.shown.springs = !view.shown.springs;
      view.shown.skin = !view.shown.springs;
      break;
    case Action::labels:
      view.shown.labels = !view.shown.labels;
      break;
    case Action::legend:
      view.shown.legend = !view.shown.legend;
      break;
    case Action::theme:
      view.theme = view.theme == render::Theme::dark ? render::Theme::light : render::Theme::dark;
      break;
    default:
      return;
  }
  desk_.scene.set_view(view);
}

void Panels::change_camera(Action action) {
  CameraHand& camera = desk_.camera;
  const auto toggle_mode = [&](CameraMode mode) { camera.set_mode(camera.mode() == mode ? CameraMode::still : mode); };
  if (action == Action::frame) frame_robots(desk_, desk_.scene.selection(), aspect_);
  if (action == Action::turntable) toggle_mode(CameraMode::turntable);
  if (action == Action::top_view) toggle_mode(CameraMode::top);
  if (action != Action::follow) return;
  if (camera.mode() == CameraMode::follow) {
    camera.set_mode(CameraMode::still);
    return;
  }
  const std::optional<RobotId> current = desk_.scene.current();
  camera.follow(current ? desk_.scene.moment().robots->index_of(*current) : std::nullopt);
}

void Panels::quit() {
  quit_with_care(desk_, [this] { quits_ = true; });
}

void Panels::escape() {
  if (desk_.dialogs.open())
    desk_.dialogs.close();
  else if (help_)
    help_ = false;
  else if (ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup))
    ImGui::SetWindowFocus(nullptr);  // closes menus and lists
  else
    desk_.scene.clear_selection();
}

}  // namespace mercury::window
