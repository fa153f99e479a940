// SPDX-License-Identifier: Apache-2.0
// What the window's scene shows for comparison (comparison.h): the second side, and ghosts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "app/live/snapshot.h"
#include "app/scene/view_settings.h"

namespace mercury {

class DrawnScene;
class SceneCore;
class SceneSelection;
struct Series;

// What a ghost shows. automatic: the robot before it was changed, if it was; else its parent, if it has one.
enum class GhostOf { automatic, unchanged, parent };

// A ghost that is wanted.
struct LiveGhost {
  RobotId robot = 0;
  bool of_parent = false;
  LiveRobot body;
};

// How a robot compares with its ghost, when it was as old as the ghost is now.
struct GhostFigures {
  RobotId robot = 0;
  bool of_parent = false;
  double age = 0;                                 // of the ghost [s]
  double robot_distance = 0, ghost_distance = 0;  // from their starts [m]
  double robot_speed = 0, ghost_speed = 0;        // distance / age [m/s]
  bool same_age = true;                           // the robot is as old as the ghost
  bool ghost_exploded = false;
};

class SceneComparison {
 public:
  explicit SceneComparison(SceneCore& core);
  ~SceneComparison();

  // The second side shows the same robots under other settings, from the moment shown on; all that changes robots or
  // time acts on both. nullopt ends it.
  void set_second(const std::optional<SideDifference>& difference);
  const std::optional<SideDifference>& second() const;
  // The second side's view; null if there is none, as while a recording is played.
  DrawnScene* second_drawn() { return second_drawn_.get(); }
  const DrawnScene* second_drawn() const { return second_drawn_.get(); }
  Series second_series(RobotId robot) const;  // empty if there is no second side

  // Ghosts of these robots, from the moment shown on, in the place of those there were. Returns how many there are:
  // robots without a parent have no ghost of it.
  std::size_t show_ghosts(const std::vector<RobotId>& robots, GhostOf of = GhostOf::automatic);
  void hide_ghosts() { show_ghosts({}); }
  const std::vector<LiveGhost>& ghosts() const { return ghosts_; }
  std::vector<GhostFigures> ghost_figures() const;
  Series ghost_series(RobotId robot) const;  // empty if it has no ghost

  // LiveScene::frame() calls both. Ends what failed, and forgets ghosts of robots that are gone.
  void update();
  // Updates the second side's view as DrawnScene::update() does. `first`: that of the first side.
  void draw(DrawnScene& first, ViewSettings shown, float aspect, const SceneSelection& selection,
            std::optional<RobotId> held);

 private:
  SceneCore& core_;
  std::unique_ptr<DrawnScene> second_drawn_;              // while there is a second side
  std::vector<LiveGhost> ghosts_;                         // that are wanted
  std::uint64_t failed_seconds_ = 0, failed_ghosts_ = 0;  // of the last snapshot
};

}  // namespace mercury
