// SPDX-License-Identifier: Apache-2.0
// What keys and menus do.
#include <fmt/format.h>
#include <imgui.h>

#include <nlohmann/json.hpp>

#include "app/window/panels/file_commands.h"
#include "app/window/panels/panels.h"
#include "app/window/panels/view_panel.h"

namespace mercury::window {

void Panels::execute(const Command& command) {
  LiveScene& scene = context_.scene;
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
    case Action::fastest:
      scene.set_speed(scene.speed() == unlimited_speed ? 1 : unlimited_speed);
      break;
    case Action::reset:
      scene.reset();
      break;
    case Action::new_random:
      robots_.random.generate(context_);
      break;
    case Action::duplicate:
      scene.duplicate(selection);
      break;
    case Action::remove:
      scene.remove(selection);
      break;
    case Action::mutate:
      robots_.mutate(context_);
      break;
    case Action::select_all:
      scene.select_all();
      break;
    case Action::deselect:
      escape();
      break;
    case Action::undo:
      if (scene.can_undo()) context_.toasts.show(Tone::info, "undone: " + scene.undo_name());
      scene.undo();
      break;
    case Action::redo:
      if (scene.can_redo()) context_.toasts.show(Tone::info, "done again: " + scene.redo_name());
      scene.redo();
      break;
    case Action::open:
      open_robots(context_);
      break;
    case Action::save:
      save_robots(context_);
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
      context_.preferences.panels = !context_.preferences.panels;
      break;
    case Action::full_screen:
      window_.toggle_full_screen();
      break;
    case Action::screenshot:
      screenshot_requested_ = true;
      break;
    case Action::record:
      film_.toggle(context_);
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
  ViewSettings view = context_.scene.view();
  const Environment& environment = context_.scene.configuration().environment;
  const bool ocean = std::holds_alternative<Ocean>(environment);
  switch (action) {
    case Action::drag_arrows:
      toggle_drag_arrows(view);
      if (view.shown.arrows.drag && !ocean) context_.toasts.show(Tone::info, "drag arrows are there in the ocean only");
      context_.log.write("view", {{"drag", view.shown.arrows.drag}});
      break;
    case Action::color:
      if (!color_by_number(view, number, environment)) return;
      context_.toasts.show(Tone::info, fmt::format("coloured by {}", view.color->key));
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
  context_.scene.set_view(view);
}

void Panels::change_camera(Action action) {
  OrbitController& camera = context_.camera;
  const auto toggle_mode = [&](CameraMode mode) { camera.set_mode(camera.mode() == mode ? CameraMode::still : mode); };
  if (action == Action::frame) frame_robots(context_, context_.scene.selection(), aspect_);
  if (action == Action::turntable) toggle_mode(CameraMode::turntable);
  if (action == Action::top_view) toggle_mode(CameraMode::top);
  if (action != Action::follow) return;
  if (camera.mode() == CameraMode::follow) {
    camera.set_mode(CameraMode::still);
    return;
  }
  const std::optional<RobotId> current = context_.scene.current();
  camera.follow(current ? context_.scene.snapshot().robots->index_of(*current) : std::nullopt);
}

void Panels::quit() {
  quit_with_confirmation(context_, [this] { quits_ = true; });
}

void Panels::escape() {
  if (context_.dialogs.open())
    context_.dialogs.close();
  else if (help_)
    help_ = false;
  else if (ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup))
    ImGui::SetWindowFocus(nullptr);  // closes menus and lists
  else
    context_.scene.clear_selection();
}

}  // namespace mercury::window
