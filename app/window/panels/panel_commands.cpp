// SPDX-License-Identifier: Apache-2.0
// The part of Panels that executes the commands of menus and keys.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

#include "app/window/panels/commands.h"
#include "app/window/panels/panels.h"
#include "app/window/panels/video_recorder.h"
#include "app/window/toolkit/widgets.h"

namespace mercury::window {

void Panels::execute(Action action) {
  switch (action) {
    case Action::play_pause:
    case Action::step:
    case Action::faster:
    case Action::slower:
    case Action::real_time:
    case Action::fastest:
    case Action::reset:
      change_time(action);
      break;
    case Action::step_back:
    case Action::first_moment:
    case Action::present:
    case Action::loop:
    case Action::bookmark:
    case Action::next_bookmark:
    case Action::previous_bookmark:
    case Action::go_on:
    case Action::fork:
      change_timeline(context_, action);
      break;
    case Action::new_random:
    case Action::duplicate:
    case Action::remove:
    case Action::mutate:
    case Action::breed:
    case Action::evolve:
    case Action::edit_body:
    case Action::rename:
    case Action::keep_selected:
    case Action::keep_best:
    case Action::detach:
    case Action::select_all:
    case Action::invert_selection:
    case Action::undo:
    case Action::redo:
    case Action::open:
    case Action::save_scene:
    case Action::save:
      change_robots(action);
      break;
    case Action::frame:
    case Action::follow:
    case Action::turntable:
    case Action::top_view:
    case Action::look_along_x:
    case Action::look_along_y:
    case Action::bookmark_1:
    case Action::bookmark_2:
    case Action::bookmark_3:
    case Action::bookmark_4:
    case Action::set_bookmark_1:
    case Action::set_bookmark_2:
    case Action::set_bookmark_3:
    case Action::set_bookmark_4:
      change_camera(action);
      break;
    case Action::drag_arrows:
    case Action::contact_arrows:
    case Action::force_arrows:
    case Action::color_material:
    case Action::color_activation:
    case Action::color_strain:
    case Action::color_force:
    case Action::color_speed:
    case Action::color_pressure:
    case Action::color_energy:
    case Action::color_stiffness:
    case Action::color_power:
    case Action::cells:
    case Action::springs:
    case Action::labels:
    case Action::legend:
    case Action::theme:
      change_view(action);
      break;
    case Action::compare:
      toggle_second_view(context_);
      break;
    case Action::ghosts:
      toggle_ghosts(context_);
      break;
    case Action::left_panels:
    case Action::right_panels: {
      const Side side = action == Action::left_panels ? Side::left : Side::right;
      open_column(side, !context_.preferences.panels || !column_open(side));
      context_.preferences.panels = true;
      break;
    }
    case Action::larger_text:
      change_text_size(context_, 1);
      break;
    case Action::smaller_text:
      change_text_size(context_, -1);
      break;
    case Action::palette:
      open_palette();
      break;
    case Action::messages:
      show("Messages");
      break;
    case Action::hide_panels:
      context_.preferences.panels = !context_.preferences.panels;
      break;
    case Action::full_screen:
      context_.window.toggle_full_screen();
      break;
    case Action::screenshot:
      context_.screenshot_requested = true;
      break;
    case Action::record:
      context_.recorder.toggle(context_);
      break;
    case Action::deselect:
      escape();
      break;
    case Action::help:
      help_open_ = !help_open_;
      break;
    case Action::quit:
      quit();
      break;
  }
}

void Panels::change_time(Action action) {
  LiveScene& scene = context_.scene;
  if (action == Action::play_pause) scene.toggle();
  if (action == Action::step) scene.step();
  if (action == Action::faster) scene.change_speed(1);
  if (action == Action::slower) scene.change_speed(-1);
  if (action == Action::real_time) scene.set_speed(1);
  if (action == Action::fastest) scene.set_speed(scene.speed() == unlimited_speed ? 1 : unlimited_speed);
  if (action == Action::reset) scene.reset();
}

void Panels::change_robots(Action action) {
  LiveScene& scene = context_.scene;
  if (action == Action::new_random) generate_robots(context_);
  if (action == Action::duplicate) scene.duplicate(scene.selection());
  if (action == Action::remove) scene.remove(scene.selection());
  if (action == Action::mutate) mutate_selected(context_);
  if (action == Action::breed) breed_selected(context_);
  if (action == Action::evolve) evolve_selected(context_);
  if (action == Action::edit_body) toggle_body_editor(context_);
  if (action == Action::rename) rename_selected(context_);
  if (action == Action::keep_selected) keep_only(context_, scene.selection());
  if (action == Action::keep_best) ask_for_best(context_);
  if (action == Action::detach) scene.remove_attachments(selected_or_all(scene));
  if (action == Action::select_all) scene.select_all();
  if (action == Action::invert_selection) invert_selection(context_);
  if (action == Action::open) open_robots(context_);
  if (action == Action::save_scene) save_scene(context_);
  if (action == Action::save) save_robots(context_);
  if (action == Action::undo) {
    if (scene.can_undo()) context_.toasts.show(Tone::info, "undone: " + scene.undo_name());
    scene.undo();
  }
  if (action == Action::redo) {
    if (scene.can_redo()) context_.toasts.show(Tone::info, "redone: " + scene.redo_name());
    scene.redo();
  }
}

void Panels::change_view(Action action) {
  ViewSettings view = context_.scene.view();
  const Environment& environment = context_.scene.configuration().environment;
  if (const ColorQuantity* quantity = quantity_of(action)) {
    if (!quantity->exists_in(environment)) return;
    color_by(view, *quantity);
    context_.toasts.show(Tone::info, fmt::format("colored by {}", quantity->key));
  }
  switch (action) {
    case Action::drag_arrows:
    case Action::contact_arrows:
    case Action::force_arrows:
      toggle_arrows(context_, action);
      return;
    case Action::cells:
      set_layout(view, view.layout == Layout::cells ? Layout::grid : Layout::cells);
      context_.toasts.show(Tone::info, view.layout == Layout::cells ? "robots stay in their cells" : "robots travel");
      context_.log.write("layout", {{"layout", name_of(view.layout)}});
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
      break;
  }
  context_.scene.set_view(view);
}

void Panels::change_camera(Action action) {
  OrbitController& camera = context_.camera;
  const auto toggle_mode = [&](CameraMode mode) { camera.set_mode(camera.mode() == mode ? CameraMode::still : mode); };
  if (action == Action::frame) frame_robots(context_, context_.scene.selection());
  if (action == Action::turntable) toggle_mode(CameraMode::turntable);
  if (action == Action::top_view) toggle_mode(CameraMode::top);
  if (action == Action::look_along_x) look_along(context_, 0);
  if (action == Action::look_along_y) look_along(context_, 1);
  const auto place = [&](Action first) { return static_cast<std::size_t>(action) - static_cast<std::size_t>(first); };
  if (action >= Action::bookmark_1 && action <= Action::bookmark_4) go_to_bookmark(context_, place(Action::bookmark_1));
  if (action >= Action::set_bookmark_1 && action <= Action::set_bookmark_4)
    set_bookmark(context_, place(Action::set_bookmark_1));
  if (action != Action::follow) return;
  if (camera.mode() == CameraMode::follow) {
    camera.set_mode(CameraMode::still);
    return;
  }
  const std::optional<RobotId> current = context_.scene.current();
  camera.follow(current ? context_.scene.snapshot().robots->index_of(*current) : std::nullopt);
}

namespace {

// Other words for what a command does.
std::string_view other_words(Action action) {
  switch (action) {
    case Action::play_pause:
      return "start stop run continue freeze";
    case Action::slower:
      return "motion";
    case Action::edit_body:
      return "paint voxels draw";
    case Action::fork:
      return "branch copy";
    case Action::turntable:
      return "spin rotate orbit";
    case Action::evolve:
      return "optimize train";
    case Action::reset:
      return "restart again";
    case Action::frame:
      return "zoom fit center all";
    case Action::top_view:
      return "above";
    case Action::new_random:
      return "generate create";
    case Action::remove:
      return "delete erase";
    case Action::duplicate:
      return "copy clone";
    case Action::undo:
      return "back revert";
    case Action::redo:
      return "again forward";
    case Action::open:
      return "load file";
    case Action::save:
    case Action::save_scene:
      return "write file";
    case Action::labels:
      return "text captions";
    case Action::theme:
      return "appearance";
    case Action::compare:
      return "split side";
    case Action::left_panels:
    case Action::right_panels:
      return "columns";
    case Action::larger_text:
    case Action::smaller_text:
      return "font size";
    case Action::screenshot:
      return "picture image photo";
    case Action::record:
      return "video film movie";
    case Action::messages:
      return "log";
    case Action::help:
      return "shortcuts manual";
    case Action::quit:
      return "exit close";
    default:
      return "";
  }
}

}  // namespace

// Commands that only menus have, and those with keys.
std::vector<PaletteEntry> Panels::palette_entries() {
  std::vector<PaletteEntry> entries;
  for (const KeyBinding& binding : key_bindings()) {
    const Action action = binding.action;
    if (quantity_of(action) || action == Action::deselect || action == Action::palette) continue;
    entries.push_back({binding.meaning, binding.group, context_.keys.keys_of(action),
                       [this, action] { execute(action); }, fmt::format("{} {}", binding.name, other_words(action))});
  }
  entries.push_back({"open a run of an evolution", "File", "", [this] { choose_run(context_); }});
  entries.push_back({"export the pose for other programs", "File", "", [this] { export_pose(context_); }});
  entries.push_back({"export the motion for other programs", "File", "", [this] { export_motion(context_); }});
  if (context_.run.is_open())
    entries.push_back({"export the run as a web page", "File", "", [this] { export_run(context_); }});
  entries.push_back({"copy as command", "File", "", [this] { copy_as_command(context_, "view"); }});
  entries.push_back({"copy as command for a video", "File", "", [this] { copy_as_command(context_, "render"); }});
  entries.push_back({"change keys", "Help", "", [this] { show_keys_file(); }});
  for (PaletteEntry& entry : settings_for_palette(context_, [this](const char* panel) { show(panel); }))
    entries.push_back(std::move(entry));
  return entries;
}

void Panels::open_palette() {
  palette_.open([this] { return palette_entries(); });
}

bool Panels::press_in_palette(const KeyPress& press, std::optional<Action> command) {
  if (!palette_.is_open()) return false;
  if (command == Action::deselect || command == Action::palette)
    palette_.close();
  else
    palette_.press(press);
  return true;
}

void Panels::quit() {
  quit_with_confirmation(context_, [this] { quit_confirmed_ = true; });
}

void Panels::escape() {
  if (close_list()) return;
  if (context_.dialogs.open())
    context_.dialogs.close();
  else if (palette_.is_open())
    palette_.close();
  else if (help_open_)
    help_open_ = false;
  else if (context_.body_edit.robot != 0)
    context_.body_edit.robot = 0;
  else
    context_.scene.clear_selection();
}

}  // namespace mercury::window
