// SPDX-License-Identifier: Apache-2.0
#include "app/window/kept_settings.h"

#include "app/live/command_text.h"
#include "app/live/session_settings.h"
#include "app/window/panels/commands.h"

namespace mercury::window {

Preferences kept_preferences(const ViewerOptions& options, const std::filesystem::path& folder) {
  Preferences preferences;
  if (!folder.empty()) load(preferences, folder / "window.json");
  if (options.size.width > 0) preferences.size = options.size;
  if (options.quality != render::Quality::automatic) preferences.quality = options.quality;
  return preferences;
}

void load_session(PanelContext& context, KeyMap& keys, const ViewerOptions& options,
                  const std::filesystem::path& folder) {
  if (folder.empty()) return;
  Messages messages;
  const SessionSettings last = load_session_settings(session_settings_path(), messages);
  show_messages(context.toasts, messages.take());
  if (options_of(options.view, Layout::cells).empty()) context.scene.set_view(last.view);
  std::error_code unknown;
  if (std::filesystem::exists(session_settings_path(), unknown)) context.creation.generation = last.generation;
  context.preferences.pause_on_explosion = last.pause_on_explosion;
  if (const std::string problem = load_keys(keys, folder / "keys.txt"); !problem.empty())
    context.toasts.show(Tone::warning, problem);
}

void save_session(PanelContext& context, const std::filesystem::path& folder) {
  if (folder.empty()) return;
  Messages ignored;  // no window is left to show them
  ViewSettings view = context.scene.view();
  view.camera = {.mode = context.camera.mode()};  // the rest of the camera belongs to this scene
  view.bookmarks = {};
  view.compare.reset();
  save_session_settings(session_settings_path(),
                        {.view = view,
                         .generation = context.creation.generation,
                         .pause_on_explosion = context.preferences.pause_on_explosion,
                         .folder = context.preferences.folder},
                        ignored);
  if (const WindowSize size = context.window.size(); size.width > 0) context.preferences.size = size;
  save(context.preferences, folder / "window.json");
}

}  // namespace mercury::window
