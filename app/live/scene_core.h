// SPDX-License-Identifier: Apache-2.0
// What the parts of the window's scene share: the document and its history, the physics thread that simulates it, the
// newest snapshot, and messages.
//
//   SceneTime  SceneSelection  SceneRobots  SceneParameters  SceneMouse  SceneComparison  SceneFiles  SceneExports
//       |            |              |              |              |             |             |            |
//       +------------+--------------+------------ SceneCore ------+-------------+-------------+------------+
//
// An edit has three steps:
//
//   SceneDocument& document = core.edit("rename eel");  // the view's moment becomes the present; undo comes back here
//   document.find(...)->...                             // the change
//   core.apply_document();                              // physics goes on with it
//
// Only the sources of these classes include this header.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/live/physics.h"
#include "app/live/scene_document.h"
#include "app/live/scene_perturbations.h"
#include "app/live/timeline_marks.h"
#include "app/options/attachment_options.h"

namespace mercury {

class SceneCore {
 public:
  // Throws InputError for an invalid configuration and DeviceError for a missing device.
  SceneCore(const Configuration& configuration, const TrialStart& start, const ViewSettings& view);

  // Fetches the newest snapshot; snapshot() is valid until the next call.
  void fetch_snapshot();
  const Snapshot& snapshot() const { return *snapshot_; }
  const std::shared_ptr<const Snapshot>& hold_snapshot() const { return snapshot_; }
  PhysicsThread& physics() { return physics_; }
  const PhysicsThread& physics() const { return physics_; }
  Messages& messages() { return messages_; }
  void report(Severity severity, std::string text) { messages_.add(severity, std::move(text)); }

  const SceneDocument& document() const { return document_; }
  // Records an edit, to be undone later, and returns the document for the change. What find() returned before may be
  // gone then. Edits with one key are one until EditHistory::end_edit().
  SceneDocument& edit(std::string name, std::string key = {});
  // Sends the document to the physics thread.
  void apply_document();
  // Applies `change` to robots as one edit. `change` returns whether it changed its robot.
  void change_robots(const std::vector<RobotId>& robots, const char* name, const std::string& key,
                     const std::function<bool(DocumentRobot&)>& change);
  // For SceneDocument::surroundings: a number that was never in use.
  std::uint64_t new_surroundings() { return ++last_surroundings_; }
  EditHistory& history() { return history_; }
  const EditHistory& history() const { return history_; }
  void undo();
  void redo();

  // The document takes the robots and parameters of the moment that is shown, as an edit if they differ. edit() does
  // so: what the user changes is what the view shows.
  void adopt_moment();
  // Another moment is about to be shown, which need not become the present.
  void leave_moment() { goes_on_ = false; }
  TimelineMarks& marks() { return marks_; }
  const TimelineMarks& marks() const { return marks_; }

  void reset();
  // The start of the document is another one: robots that have not left theirs begin again.
  void follow_start();

  ScenePerturbations& perturbations() { return perturbations_; }
  const ScenePerturbations& perturbations() const { return perturbations_; }
  // Holds these as soon as their robots are there; no edit of its own.
  void hold_opened(HeldParts held);
  // Call it in each frame: holds what waits for its robots, and forgets what belongs to robots that are gone.
  // `complete`: no more robots will come, report what is missing.
  void update_held(bool complete);

  const ViewSettings& view() const { return view_; }
  void set_view(const ViewSettings& settings);

 private:
  // Holds the actuators and neurons whose robots are there. Returns whether the document has changed.
  bool hold_waiting(bool complete);
  void travel(void (EditHistory::*travel_in)(SceneDocument&));

  Messages messages_;
  PhysicsThread physics_;
  SceneDocument document_;
  EditHistory history_;
  ViewSettings view_;
  std::shared_ptr<const Snapshot> snapshot_;
  ScenePerturbations perturbations_{document_, physics_};
  TimelineMarks marks_;
  HeldParts to_hold_;     // of a scene whose robots are not all there yet; perturbations_ has the attached ones
  bool goes_on_ = false;  // the moment shown becomes the present; physics has not done so yet
  std::uint64_t last_surroundings_ = 0;
};

}  // namespace mercury
