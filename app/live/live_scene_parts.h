// SPDX-License-Identifier: Apache-2.0
// The private state of LiveScene, and small functions that its source files share.
#pragma once

#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "app/live/live_scene.h"
#include "app/options/scene_file.h"

namespace mercury {

// The robots as their files hold them. A robot of the scene is saved if both are equal.
class SavedRobots {
 public:
  // `file` may be empty: the robot needs no saving.
  void note(const LiveRobot& body, std::string file) { saved_[body.id] = {std::move(file), body}; }
  bool holds(const LiveRobot& body) const { return has_body(body) && saved_.at(body.id).body.name == body.name; }
  bool has_body(const LiveRobot& body) const {  // its name may differ
    const auto found = saved_.find(body.id);
    return found != saved_.end() && found->second.body.robot == body.robot &&
           found->second.body.materials == body.materials;
  }
  std::optional<std::string> file_of(RobotId id) const {
    const auto found = saved_.find(id);
    return found == saved_.end() ? std::nullopt : std::optional(found->second.file);
  }

 private:
  struct Saved {
    std::string file;
    LiveRobot body;
  };
  std::map<RobotId, Saved> saved_;
};

// What pulls at the robots: the mouse, and the pins and springs of the document, which stay. A change is sent to the
// physics thread at once.
class ScenePulls {
 public:
  ScenePulls(SceneDocument& document, PhysicsThread& physics) : document_(document), physics_(physics) {}

  // The mouse.
  const std::optional<LivePerturbation>& by_mouse() const { return by_mouse_; }
  void set_by_mouse(std::optional<LivePerturbation> pull);

  // What stays.
  void attach(LivePerturbation spring);
  bool attached_to(const std::vector<RobotId>& robots) const;
  void detach(const std::vector<RobotId>& robots);
  void send();
  // To be called in each frame: forgets attachments of robots that are gone, and moves pins after a reset.
  void update(const Snapshot& now);
  void before_reset(const Snapshot& now);
  // Attaches these as soon as their robots are there.
  void attach_later(std::vector<AttachedMass> masses) { to_attach_ = std::move(masses); }
  // Does so. `complete`: no more robots will come, report what is missing.
  void attach_opened(bool complete, Messages& messages);
  // Undo or redo has replaced the document: pins that were there before stay where they are, and pins that come back
  // from before a reset hold their masses where these are now.
  void aim_pins(const std::vector<Attachment>& before, const Snapshot& now);
  // What was attached at the moment shown.
  std::vector<Attachment> attached_at(const Snapshot& moment) const;

 private:
  SceneDocument& document_;
  PhysicsThread& physics_;
  std::optional<LivePerturbation> by_mouse_;
  std::vector<AttachedMass> to_attach_;     // of a scene whose robots are not all there yet
  std::uint64_t resets_ = 0;                // of the scene
  std::optional<std::uint64_t> pins_wait_;  // pins are off until a snapshot of the present has more resets than this
};

// What the user marks on the timeline. Times in s; those that differ by less than a step of any run are one.
class TimelineMarks {
 public:
  const std::vector<double>& bookmarks() const { return bookmarks_; }  // ascending
  bool toggle_bookmark(double now);                                    // returns whether there is one now
  std::optional<double> next_bookmark(double now, int direction) const;
  void forget_bookmarks_after(double time);

  // A loop that has its begin, but not its end.
  const std::optional<double>& loop_begin() const { return loop_begin_; }
  // Begins a loop, or returns its times.
  std::optional<std::pair<double, double>> mark_loop(double now);
  void forget_loop() { loop_begin_.reset(); }
  // The times in ascending order, if there is a loop between them.
  static std::optional<std::pair<double, double>> loop_between(double a, double b);

 private:
  std::vector<double> bookmarks_;
  std::optional<double> loop_begin_;
};

// The robots that are selected, in the order of selection.
class SceneSelection {
 public:
  const std::vector<RobotId>& ids() const { return ids_; }
  bool contains(RobotId id) const { return std::ranges::find(ids_, id) != ids_.end(); }
  void set(std::vector<RobotId> ids) { ids_ = std::move(ids); }
  void remove(RobotId id) { std::erase(ids_, id); }
  void add(RobotId id) {  // or makes it the last one
    remove(id);
    ids_.push_back(id);
  }
  void keep(const SceneDocument& document);  // those that are there
  std::set<RobotId> set() const { return {ids_.begin(), ids_.end()}; }

 private:
  std::vector<RobotId> ids_;
};

struct LiveScene::Parts {
  explicit Parts(const LiveSceneOptions& options)
      : physics(options.configuration, messages), view(options.view), background(messages) {}

  Messages messages;
  PhysicsThread physics;
  SceneDocument document;
  EditHistory history;
  ViewSettings view;
  SavedRobots saved;
  RobotId last_id = 0;

  std::shared_ptr<const Snapshot> snapshot;
  DrawnScene drawn;
  std::unique_ptr<DrawnScene> second_drawn;  // while there is a second side
  bool pointed_second = false;               // the mouse is on the second side
  std::vector<LiveGhost> ghosts;             // that are wanted
  float aspect = 16.0f / 9;
  std::optional<bool> from_above;  // see LiveScene::face
  std::optional<render::Orbit> facing;
  SceneSelection selection;
  std::set<RobotId> hidden;
  bool playing = false, pauses_on_explosion = false;
  std::uint64_t stops = 0, failed_seconds = 0, failed_ghosts = 0;  // of the last snapshot
  double speed = 1;
  std::optional<CameraPlan> camera;  // of a scene that was opened
  ScenePulls pulls{document, physics};
  TimelineMarks marks;
  bool goes_on = false;  // the moment shown becomes the present; physics has not done so yet
  std::uint64_t last_surroundings = 0;
  std::filesystem::path scene_file;  // opened or saved last
  HeldParts to_hold;                 // of a scene whose robots are not all there yet; pulls has the attached ones
  RobotId watched_brain = 0;
  int brain_frames = 0;       // until snapshots stop reading it
  mutable int described = 0;  // frames until snapshots stop reading velocities for describe()

  Background background;  // last: its tasks end before the members that they use

  // Holds the actuators and neurons that wait for it, of robots that are there. `complete`: no more will come, report
  // what is missing. Returns whether the document has changed.
  bool hold_opened(bool complete);
  // Sends the document to the physics thread.
  void apply_document() {
    hold_opened(false);                    // first, so that no step is made without it
    pulls.attach_opened(false, messages);  // the same
    physics.set_start(document.start);
    std::vector<LiveRobot> bodies;
    for (const DocumentRobot& robot : document.robots) bodies.push_back(robot.body);
    physics.set_scene(std::move(bodies), document.configuration, document.surroundings);
  }
  void reset() {
    pulls.before_reset(*snapshot);
    physics.reset();
  }
  // The start of the document is another one. Robots that have not left theirs begin again.
  void follow_start() {
    if (snapshot->steps == 0 && !snapshot->timeline.recording) reset();
  }
  // Undo or redo.
  void travel(void (EditHistory::*travel_in)(SceneDocument&));
  // Call it before the document changes: records the edit, to be undone later.
  void edit(std::string name, std::string key = {}) {
    adopt_moment();
    history.before_change(document, std::move(name), std::move(key));
  }
  void report(Severity severity, std::string text) { messages.add(severity, std::move(text)); }
  DocumentRobot* find(RobotId id) {
    for (DocumentRobot& robot : document.robots)
      if (robot.body.id == id) return &robot;
    return nullptr;
  }
  void adopt_moment();
  void forget_later_bookmarks();
  bool points_at_second() const { return pointed_second && second_drawn && snapshot->second; }
  const Snapshot& pointed_snapshot() const { return points_at_second() ? *snapshot->second : *snapshot; }
  const DrawnScene& pointed_drawn() const { return points_at_second() ? *second_drawn : drawn; }
  void update_second_drawn(ViewSettings shown, const std::optional<RobotId>& held);
  // Forgets ghosts of robots that are gone.
  void update_ghosts();
  void play_recording(const std::shared_ptr<TrajectoryReader>& recording, const std::filesystem::path& file);
  // Applies `change` to robots as one edit. `change` returns whether it changed its robot.
  bool change_robots(const std::vector<RobotId>& robots, const char* name, const std::string& key,
                     const std::function<bool(DocumentRobot&)>& change);
  RobotId append(Robot robot, RobotProvenance source);
  // Reports robots that break a rule and leaves them out.
  void remove_invalid(std::vector<Robot>& robots);
  std::vector<RobotId> append_valid(std::vector<Robot> robots, bool unsaved);
  void let_travel();
  // Clears the scene and sets what else the file says. `environments`: those that its robots are made for.
  void open_scene(const SceneFile& scene, std::span<const Robot* const> robots);
  void replay(const std::shared_ptr<const Repro>& repro, const std::filesystem::path& file);
  void place_child(const LiveRobot& parent, Robot child, bool replace);
  std::string free_name(const std::string& wanted) const;
  std::optional<PerturbationDetails> details_of(const LivePerturbation& pull);
};

// "1 robot", "2 robots".
inline std::string robot_count_text(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " robot" : " robots");
}

}  // namespace mercury
