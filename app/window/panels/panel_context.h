// SPDX-License-Identifier: Apache-2.0
// What every panel works on.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "app/live/live_scene.h"
#include "app/window/dialogs/dialogs.h"
#include "app/window/toolkit/event_log.h"
#include "app/window/toolkit/preferences.h"
#include "app/window/toolkit/toasts.h"
#include "app/window/viewport/orbit_controller.h"

namespace mercury::window {

struct PanelContext {
  LiveScene& scene;
  OrbitController& camera;
  Preferences& preferences;
  EventLog& log;
  Toasts& toasts;
  Dialogs& dialogs;
};

// The selected robots; all where none is selected.
std::vector<RobotId> selected_or_all(const LiveScene& scene);

// Looks at these robots; all where there are none.
void frame_robots(PanelContext& context, const std::vector<RobotId>& robots, float aspect);

// The boxes of these robots in the picture, as far as they are there.
std::vector<render::Bounds> boxes_of(LiveScene& scene, const std::vector<RobotId>& robots);

// Does something while the scene's camera is the one in the user's hand.
void with_window_camera(PanelContext& context, const std::function<void()>& act);

// Saves by `save(overwrite)`; where files exist, asks first. Tells how it went.
void save_with_confirmation(PanelContext& context, const std::string& what,
                            std::function<SaveResult(bool overwrite)> save);

}  // namespace mercury::window
