// SPDX-License-Identifier: Apache-2.0
// The robots of the window's scene: adding, making, changing and removing them. Each change is an edit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/live/scene_document.h"
#include "app/live/voxel_edit.h"
#include "mercury/generator.h"

namespace mercury {

class Background;
class SavedRobots;
class SceneCore;
class SceneSelection;
struct Hit;

// One entry of the list of robots.
struct RobotEntry {
  RobotId id = 0;
  std::string name;
  std::size_t masses = 0, springs = 0, faces = 0;
  std::string file;                                      // read from or saved to it; empty = none
  bool unsaved = false;                                  // differs from its file
  bool selected = false, hidden = false, tuned = false;  // tuned: its materials were changed
  bool exploded = false;
  double exploded_at = 0;                    // [s]
  std::uint32_t culprit_spring = no_spring;  // index in Robot::springs
};

class SceneRobots {
 public:
  SceneRobots(SceneCore& core, const SceneSelection& selection, SavedRobots& saved, Background& background)
      : core_(core), selection_(selection), saved_(saved), background_(background) {}

  std::vector<RobotEntry> entries() const;
  std::size_t count() const;

  // Returns the ids of those that can be used. `unsaved`: they are in no file.
  std::vector<RobotId> add(std::vector<Robot> robots, bool unsaved = true);
  // Shows these robots alone, in this configuration (but on the same device), as one edit. They need no saving.
  void show(std::vector<Robot> robots, const Configuration& configuration, const std::string& edit);
  void remove(const std::vector<RobotId>& robots);
  void clear();
  void rename(RobotId robot, const std::string& name);
  void duplicate(const std::vector<RobotId>& robots);
  // Copies of robots in the state of the moment shown, which goes on. Returns their ids.
  std::vector<RobotId> fork(const std::vector<RobotId>& robots);

  // Makes random robots in the background. `replace`: they replace all robots. `lively`: the liveliest of ten times as
  // many (mercury/lively.h), tried in the scene's environment.
  void generate(const RandomRobots& generation, bool replace = false, bool lively = false);
  // Makes a child of each robot in the background, beside its parent or in its place. Only robots with a known
  // generator can have children.
  void mutate(const std::vector<RobotId>& robots, const MutationRequest& mutation, bool replace = false);
  // Makes a child of two robots in the background. Both must be of one generator.
  void breed(RobotId a, RobotId b, std::uint64_t seed);

  // Edits of a voxel robot's body. The robot goes on where it is, and what is attached to it comes off. edit_voxel()
  // returns false, with a message, if the edit cannot be made.
  bool has_voxels(RobotId robot) const;
  std::optional<VoxelSide> voxel_side(const Hit& hit) const;
  bool edit_voxel(RobotId robot, const VoxelSide& side, const VoxelEdit& edit);

  // Appends a robot to a document that is being edited. It is saved if its source has a file.
  const LiveRobot& append(SceneDocument& document, Robot robot, RobotProvenance source = {});

 private:
  // Reports robots that break a rule and leaves them out.
  void remove_invalid(std::vector<Robot>& robots) const;
  std::vector<RobotId> append_all(SceneDocument& document, std::vector<Robot> robots, bool unsaved);
  // Adds a child at the end of the list, or in its parent's place.
  void place_child(SceneDocument& document, const LiveRobot& parent, Robot child, bool replace);

  SceneCore& core_;
  const SceneSelection& selection_;
  SavedRobots& saved_;
  Background& background_;
  RobotId last_id_ = 0;
};

}  // namespace mercury
