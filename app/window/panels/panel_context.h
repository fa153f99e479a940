// SPDX-License-Identifier: Apache-2.0
// What a panel may read and change. The viewer owns all of it and passes it to each panel in each frame.
#pragma once

#include <optional>
#include <utility>

#include "app/live/live_run.h"
#include "app/live/live_scene.h"
#include "app/window/dialogs/dialogs.h"
#include "app/window/panels/body_edit.h"
#include "app/window/panels/frame_history.h"
#include "app/window/toolkit/event_log.h"
#include "app/window/toolkit/key_map.h"
#include "app/window/toolkit/preferences.h"
#include "app/window/toolkit/toasts.h"
#include "app/window/toolkit/window.h"
#include "app/window/viewport/mouse_controller.h"
#include "app/window/viewport/orbit_controller.h"
#include "app/window/viewport/viewport.h"

namespace mercury::window {

class VideoRecorder;

// The settings with which the window makes new robots.
struct RobotCreation {
  RandomRobots generation{.count = 6};  // random robots
  bool replace = true;                  // random robots replace the robots of the scene
  MutationRequest mutation;
};

// A drag along the timeline.
struct Scrub {
  bool plays_on = false;  // robots play again when the drag ends
  double time = 0;        // of the last moment that was asked for [s]
};

// The moment under the mouse, over a plot or the timeline: all of them show it in the next frame.
struct TimeCursor {
  std::optional<double> time, next;  // [s]
  void begin_frame() { time = std::exchange(next, std::nullopt); }
};

struct PanelContext {
  LiveScene& scene;          // robots, physics, undo, colors
  LiveRun& run;              // the evolution that is open
  OrbitController& camera;   // the camera of the viewport
  Preferences& preferences;  // window settings, kept for the next start
  const KeyMap& keys;        // which key gives which command
  EventLog& log;             // names items for tests and logs events
  Toasts& toasts;            // short messages
  Dialogs& dialogs;          // modal dialogs
  Window& window;
  const Viewport& viewport;
  VideoRecorder& recorder;
  FrameHistory& frame_history;
  RobotCreation creation = {};
  EvolveRequest evolve = {};  // the settings of the last evolution
  Scrub scrub = {};
  TimeCursor cursor = {};
  BodyEdit body_edit = {};
  RobotMenu robot_menu = {};
  UsedGestures gestures = {};         // of this session
  Box legend = {}, caption = {};      // over the viewport, in the last frame
  float aspect = 16.0f / 9;           // width / height of the viewport in this frame
  bool screenshot_requested = false;  // set it to take one at the end of the frame
};

}  // namespace mercury::window
