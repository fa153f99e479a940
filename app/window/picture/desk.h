// SPDX-License-Identifier: Apache-2.0
// What every panel works on.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "app/live/live_scene.h"
#include "app/window/dialogs/dialogs.h"
#include "app/window/picture/camera_hand.h"
#include "app/window/toolkit/observations.h"
#include "app/window/toolkit/preferences.h"
#include "app/window/toolkit/toasts.h"

namespace mercury::window {

struct Desk {
  LiveScene& scene;
  CameraHand& camera;
  Preferences& preferences;
  Observations& observations;
  Toasts& toasts;
  Dialogs& dialogs;
};

// The selected robots; all where none is selected.
std::vector<RobotId> chosen_robots(const LiveScene& scene);

// Looks at these robots; all where there are none.
void frame_robots(Desk& desk, const std::vector<RobotId>& robots, float aspect);

// The boxes of these robots in the picture, as far as they are there.
std::vector<render::Bounds> boxes_of(LiveScene& scene, const std::vector<RobotId>& robots);

// Does something while the scene's camera is the one in the user's hand.
void as_seen(Desk& desk, const std::function<void()>& act);

// Saves by `save(overwrite)`; where files exist, asks first. Tells how it went.
void save_with_care(Desk& desk, const std::string& what, std::function<SaveResult(bool overwrite)> save);

}  // namespace mercury::window
