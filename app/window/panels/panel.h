// SPDX-License-Identifier: Apache-2.0
// A panel: the content of one of the two columns of the window, and the table of all panels.
//
// To add a panel, write a class that derives from Panel and a function that makes it in a new file x_panel.cpp, and add
// a row to the table in panel_table.cpp. The icon in the rail, its tooltip, the entry in the View menu and the setting
// that keeps the panel open derive from the row; CMake finds every *_panel.cpp in this folder.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "app/live/live_run.h"
#include "app/live/live_scene.h"
#include "app/live/picking.h"
#include "app/live/voxel_edit.h"
#include "app/window/dialogs/dialogs.h"
#include "app/window/toolkit/event_log.h"
#include "app/window/toolkit/frame_times.h"
#include "app/window/toolkit/key_map.h"
#include "app/window/toolkit/plot.h"
#include "app/window/toolkit/preferences.h"
#include "app/window/toolkit/toasts.h"
#include "app/window/toolkit/window.h"
#include "app/window/viewport/mouse_controller.h"
#include "app/window/viewport/orbit_controller.h"
#include "app/window/viewport/thumbnails.h"
#include "app/window/viewport/viewport.h"
#include "mercury/generator.h"

namespace mercury::window {

class VideoRecorder;
struct PanelContext;

// The settings with which the window makes new robots.
struct RobotCreation {
  RandomRobots generation{.count = 6};  // random robots
  bool replace = true;                  // random robots replace the robots of the scene
  bool lively = true;                   // the liveliest of ten times as many
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

// Plots over time that share the moment with the timeline: a line marks the time of the view, and a drag with Ctrl goes
// through time (measure_panel.cpp).
struct TimePlots {
  PlotView view;
  bool scrubs = false;
  void begin(const PanelContext& context);
  void end(PanelContext& context);
};

// The body that is edited and the tool in use (body_editor.cpp).
struct BodyEdit {
  RobotId robot = 0;  // 0 = none
  VoxelEdit edit{.tool = VoxelTool::add};
};

// The menu of a right click (robot_list.h).
struct RobotMenu {
  bool requested = false;  // it opens in the next frame
  RobotId robot = 0;
  std::optional<Hit> hit;  // in the view
};

// What a panel may read and change. The viewer owns all of it and passes it to each panel in each frame.
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
  Thumbnails& thumbnails;  // pictures of robots in lists
  RobotCreation creation = {};
  EvolveRequest evolve = {};  // the settings of the last evolution
  Scrub scrub = {};
  TimeCursor cursor = {};
  BodyEdit body_edit = {};
  RobotMenu robot_menu = {};
  std::optional<Hit> pinned = {};      // the mass and spring that were clicked, while their robot is selected
  std::optional<Hit> new_probe = {};   // to be plotted over time
  std::vector<RobotId> to_frame = {};  // robots that the camera shows as soon as they are drawn
  UsedGestures gestures = {};          // of this session
  Box legend = {}, caption = {}, first_steps = {}, message = {};  // over the viewport, in the last frame
  std::vector<Box> covered = {};      // by what panels draw over the viewport, in this frame
  float aspect = 16.0f / 9;           // width / height of the viewport in this frame
  bool screenshot_requested = false;  // set it to take one at the end of the frame
};

class Panel {
 public:
  virtual ~Panel() = default;

  // Draws the panel with ImGui. Called once per frame while its tab is open.
  virtual void draw(PanelContext& context) = 0;

  // Takes over results of background tasks. Called once per frame, whether the tab is open or not.
  virtual void work(PanelContext& context);
};

enum class Side { left, right };

struct PanelEntry {
  const char* title;    // also the panel's name in settings and in the event log
  const char* icon;     // in the rail, a letter of Font Awesome 4
  const char* tooltip;  // of the icon; the View menu shows it beside the title
  Side side;
  std::unique_ptr<Panel> (*make)(PanelContext& context);
};

// All panels, in the order of their icons.
std::span<const PanelEntry> panel_table();

}  // namespace mercury::window
