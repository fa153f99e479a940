// SPDX-License-Identifier: Apache-2.0
// The scene of the interactive window: everything that the window does except windows and OpenGL.
//
//   SceneDocument (robots, parameters; edits, undo) --> PhysicsThread --> Snapshot --> DrawnScene --> the window draws
//
// An edit changes the document on the window's thread and sends it to the physics thread; frame() fetches the newest
// snapshot. Reading files and making robots are background tasks; their results enter the document in frame().
//
// What can be done with a scene is in classes, one per concept, each with a header of its own: include those that you
// use. What they share is in scene_core.h.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/live/drawn_scene.h"
#include "app/live/messages.h"
#include "app/live/scene_document.h"
#include "app/options/trial_start.h"
#include "app/scene/view_settings.h"

namespace mercury {

class Measurements;
class SceneComparison;
class SceneExports;
class SceneFiles;
class SceneMouse;
class SceneParameters;
class SceneRobots;
class SceneSelection;
class SceneTime;
struct ExplodedRobot;
struct Explosion;
struct Work;

struct LiveSceneOptions {
  Configuration configuration;
  TrialStart start;
  ViewSettings view;
};

// All members, and those of the classes that it gives, are called from one thread. None waits for physics or for files,
// except those named wait_*. Errors are reported by take_messages(); only the constructor throws.
class LiveScene {
 public:
  // Throws InputError for an invalid configuration and DeviceError for a missing device.
  explicit LiveScene(const LiveSceneOptions& options = {});
  ~LiveScene();

  // Call it first in every frame: fetches the newest snapshot and the results of background tasks, and updates
  // drawn(). `aspect` is the view's width divided by its height; the layout of the robots depends on it.
  void frame(float aspect = 16.0f / 9);
  // What a grid faces from the next frame() on; before the first call, the camera of view() decides. From above, the
  // robots lie beside each other, as on the ground. `direction`: else the angles of the eye; absent = those of view().
  void face(bool from_above, const std::optional<render::Orbit>& direction = {});
  const Snapshot& snapshot() const;  // of the last frame(); valid until the next one
  std::shared_ptr<const Snapshot> hold_snapshot() const;
  DrawnScene& drawn();
  std::vector<Message> take_messages();
  std::string device_name() const;
  int cuda_device() const;  // of all robots; -1 = none, or several
  // Positions stay on the GPU and reach the renderer by this bridge. The bridge's context must be current in the
  // destructor.
  void set_bridge(std::shared_ptr<PositionBridge> bridge);

  SceneTime& time();              // scene_time.h: play, speed, seek, loop, bookmarks
  SceneSelection& selection();    // scene_selection.h: selected and hidden robots
  SceneRobots& robots();          // scene_robots.h: add, make, change and remove them
  SceneParameters& parameters();  // scene_parameters.h: configuration, start, materials, drives by hand
  SceneMouse& mouse();            // scene_mouse.h: pick, perturb, pin
  SceneComparison& comparison();  // scene_comparison.h: the second side, ghosts
  SceneFiles& files();            // scene_files.h: open and save
  SceneExports& exports();        // scene_exports.h: poses, motions, videos
  const SceneTime& time() const;
  const SceneSelection& selection() const;
  const SceneRobots& robots() const;
  const SceneParameters& parameters() const;
  const SceneMouse& mouse() const;
  const SceneComparison& comparison() const;
  const SceneFiles& files() const;
  const Measurements& measurements() const;  // measurements.h, of all robots

  const SceneDocument& document() const;
  const ViewSettings& view() const;
  void set_view(const ViewSettings& settings);  // details that the environment lacks are ignored

  // Undo and redo. Successive changes of one kind, such as those of a slider, are one edit until end_edit().
  const EditHistory& history() const;
  void undo();
  void redo();
  void end_edit();
  void forget_edits();  // there is nothing to undo or redo then

  std::vector<Work> work() const;  // background.h: running and waiting tasks, for progress bars
  void cancel_work(std::uint64_t work);
  void wait_for_work();    // until all background tasks have ended and their results are in the scene
  void wait_until_done();  // also until physics has carried out all commands; calls frame()

  // Until some frames without a call, snapshots have the activity of this robot's brain.
  void watch_brain(RobotId robot);
  std::vector<ExplodedRobot> exploded() const;  // picking.h; in the snapshot, without hidden robots
  std::vector<Explosion> take_explosions();     // replay_log.h; since the last call

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace mercury
