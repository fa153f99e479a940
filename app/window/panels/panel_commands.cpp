// SPDX-License-Identifier: Apache-2.0
// The part of Panels that executes the commands of menus and keys.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

#include "app/live/scene_mouse.h"
#include "app/live/scene_robots.h"
#include "app/live/scene_selection.h"
#include "app/live/scene_time.h"
#include "app/window/panels/commands.h"
#include "app/window/panels/panels.h"
#include "app/window/panels/video_recorder.h"
#include "app/window/toolkit/widgets.h"

namespace mercury::window {

namespace {

void toggle_fastest(PanelContext& context) {
  context.scene.time().set_speed(context.scene.time().speed() == unlimited_speed ? 1 : unlimited_speed);
}

void undo(PanelContext& context) {
  LiveScene& scene = context.scene;
  if (scene.history().can_undo()) context.toasts.show(Tone::info, "undone: " + scene.history().undo_name());
  scene.undo();
}

void redo(PanelContext& context) {
  LiveScene& scene = context.scene;
  if (scene.history().can_redo()) context.toasts.show(Tone::info, "redone: " + scene.history().redo_name());
  scene.redo();
}

void color_robots(PanelContext& context, const ColorQuantity& quantity) {
  if (!quantity.exists_in(context.scene.document().configuration.environment)) return;
  change_view(context, [&](ViewSettings& view) { color_by(view, quantity); });
  context.toasts.show(Tone::info, fmt::format("colored by {}", quantity.key));
}

void toggle_cells(PanelContext& context) {
  const Layout layout = context.scene.view().layout == Layout::cells ? Layout::grid : Layout::cells;
  change_view(context, [&](ViewSettings& view) { set_layout(view, layout); });
  context.toasts.show(Tone::info, layout == Layout::cells ? "robots stay in their cells" : "robots travel");
  context.log.write("layout", {{"layout", name_of(layout)}});
}

void toggle_springs(PanelContext& context) {
  change_view(context, [](ViewSettings& view) {
    view.shown.springs = !view.shown.springs;
    view.shown.skin = !view.shown.springs;
  });
}

template <bool Shown::*detail>
void toggle_detail(PanelContext& context) {
  change_view(context, [](ViewSettings& view) { view.shown.*detail = !(view.shown.*detail); });
}

void toggle_theme(PanelContext& context) {
  change_view(context, [](ViewSettings& view) {
    view.theme = view.theme == render::Theme::dark ? render::Theme::light : render::Theme::dark;
  });
}

template <CameraMode mode>
void toggle_mode(PanelContext& context) {
  context.camera.set_mode(context.camera.mode() == mode ? CameraMode::still : mode);
}

void toggle_following(PanelContext& context) {
  if (context.camera.mode() == CameraMode::follow) return context.camera.set_mode(CameraMode::still);
  const std::optional<RobotId> current = context.scene.selection().current();
  context.camera.follow(current ? context.scene.snapshot().robots->index_of(*current) : std::nullopt);
}

// What the commands do that need no state of Panels.
struct Deed {
  Action action;
  void (*perform)(PanelContext& context);
};
constexpr Deed deeds[] = {
    {Action::play_pause, [](PanelContext& context) { context.scene.time().toggle(); }},
    {Action::step, [](PanelContext& context) { context.scene.time().step(); }},
    {Action::step_back, [](PanelContext& context) { context.scene.time().step_back(); }},
    {Action::first_moment,
     [](PanelContext& context) { context.scene.time().seek(context.scene.snapshot().timeline.begin); }},
    {Action::present, [](PanelContext& context) { context.scene.time().seek(context.scene.snapshot().timeline.head); }},
    {Action::loop, mark_loop},
    {Action::bookmark, toggle_bookmark},
    {Action::next_bookmark, [](PanelContext& context) { context.scene.time().seek_bookmark(1); }},
    {Action::previous_bookmark, [](PanelContext& context) { context.scene.time().seek_bookmark(-1); }},
    {Action::go_on, go_on},
    {Action::fork, fork},
    {Action::faster, [](PanelContext& context) { context.scene.time().change_speed(1); }},
    {Action::slower, [](PanelContext& context) { context.scene.time().change_speed(-1); }},
    {Action::real_time, [](PanelContext& context) { context.scene.time().set_speed(1); }},
    {Action::fastest, toggle_fastest},
    {Action::reset, [](PanelContext& context) { context.scene.time().reset(); }},

    {Action::frame, [](PanelContext& context) { frame_robots(context, context.scene.selection().robots()); }},
    {Action::follow, toggle_following},
    {Action::turntable, toggle_mode<CameraMode::turntable>},
    {Action::top_view, toggle_mode<CameraMode::top>},
    {Action::look_along_x, [](PanelContext& context) { look_along(context, 0); }},
    {Action::look_along_y, [](PanelContext& context) { look_along(context, 1); }},
    {Action::bookmark_1, [](PanelContext& context) { go_to_bookmark(context, 0); }},
    {Action::bookmark_2, [](PanelContext& context) { go_to_bookmark(context, 1); }},
    {Action::bookmark_3, [](PanelContext& context) { go_to_bookmark(context, 2); }},
    {Action::bookmark_4, [](PanelContext& context) { go_to_bookmark(context, 3); }},
    {Action::set_bookmark_1, [](PanelContext& context) { set_bookmark(context, 0); }},
    {Action::set_bookmark_2, [](PanelContext& context) { set_bookmark(context, 1); }},
    {Action::set_bookmark_3, [](PanelContext& context) { set_bookmark(context, 2); }},
    {Action::set_bookmark_4, [](PanelContext& context) { set_bookmark(context, 3); }},

    {Action::new_random, generate_robots},
    {Action::duplicate,
     [](PanelContext& context) { context.scene.robots().duplicate(context.scene.selection().robots()); }},
    {Action::remove, [](PanelContext& context) { context.scene.robots().remove(context.scene.selection().robots()); }},
    {Action::mutate, mutate_selected},
    {Action::breed, breed_selected},
    {Action::evolve, evolve_selected},
    {Action::edit_body, toggle_body_editor},
    {Action::rename, rename_selected},
    {Action::keep_selected, [](PanelContext& context) { keep_only(context, context.scene.selection().robots()); }},
    {Action::keep_best, [](PanelContext& context) { ask_for_best(context); }},
    {Action::detach,
     [](PanelContext& context) { context.scene.mouse().remove_attachments(selected_or_all(context.scene)); }},
    {Action::select_all, [](PanelContext& context) { context.scene.selection().select_all(); }},
    {Action::invert_selection, invert_selection},
    {Action::undo, undo},
    {Action::redo, redo},
    {Action::open, open_robots},
    {Action::save_scene, save_scene},
    {Action::save, save_robots},

    {Action::drag_arrows, [](PanelContext& context) { toggle_arrows(context, Action::drag_arrows); }},
    {Action::contact_arrows, [](PanelContext& context) { toggle_arrows(context, Action::contact_arrows); }},
    {Action::force_arrows, [](PanelContext& context) { toggle_arrows(context, Action::force_arrows); }},
    {Action::cells, toggle_cells},
    {Action::springs, toggle_springs},
    {Action::labels, toggle_detail<&Shown::labels>},
    {Action::legend, toggle_detail<&Shown::legend>},
    {Action::theme, toggle_theme},
    {Action::compare, toggle_second_view},
    {Action::ghosts, [](PanelContext& context) { toggle_ghosts(context); }},

    {Action::hide_panels, [](PanelContext& context) { context.preferences.panels = !context.preferences.panels; }},
    {Action::larger_text, [](PanelContext& context) { change_text_size(context, 1); }},
    {Action::smaller_text, [](PanelContext& context) { change_text_size(context, -1); }},
    {Action::full_screen, [](PanelContext& context) { context.window.toggle_full_screen(); }},
    {Action::screenshot, [](PanelContext& context) { context.screenshot_requested = true; }},
    {Action::record, [](PanelContext& context) { context.recorder.toggle(context); }},
};

}  // namespace

void Panels::execute(Action action) {
  if (const ColorQuantity* quantity = quantity_of(action)) return color_robots(context_, *quantity);
  const auto* deed = std::ranges::find(deeds, action, &Deed::action);
  if (deed != std::end(deeds)) return deed->perform(context_);
  if (action == Action::left_panels || action == Action::right_panels) {
    const Side side = action == Action::left_panels ? Side::left : Side::right;
    open_column(side, !context_.preferences.panels || !column_open(side));
    context_.preferences.panels = true;
  }
  if (action == Action::palette) open_palette();
  if (action == Action::messages) show("Messages");
  if (action == Action::deselect) escape();
  if (action == Action::help) help_open_ = !help_open_;
  if (action == Action::quit) quit();
  constexpr std::size_t of_panels = 7, colors = 9;  // commands above, and those of quantity_of()
  static_assert(std::size(deeds) + of_panels + colors == static_cast<std::size_t>(Action::quit) + 1);
}

// Commands that only menus have, and those with keys.
std::vector<PaletteEntry> Panels::palette_entries() {
  std::vector<PaletteEntry> entries;
  for (const KeyBinding& binding : key_bindings()) {
    const Action action = binding.action;
    if (quantity_of(action) || action == Action::deselect || action == Action::palette) continue;
    entries.push_back({binding.meaning, binding.group, context_.keys.keys_of(action),
                       [this, action] { execute(action); }, fmt::format("{} {}", binding.name, binding.words)});
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
    context_.scene.selection().clear();
}

}  // namespace mercury::window
