// SPDX-License-Identifier: Apache-2.0
// The robots of the window's scene that are selected, and those that are hidden.
#pragma once

#include <optional>
#include <set>
#include <vector>

#include "app/live/snapshot.h"

namespace mercury {

struct SceneDocument;

// The current robot is the one selected last.
class SceneSelection {
 public:
  explicit SceneSelection(const SceneDocument& document) : document_(document) {}

  void select(RobotId robot, bool alone = true);
  void toggle(RobotId robot);
  void select_all();
  void clear() { ids_.clear(); }
  void set(const std::vector<RobotId>& robots);  // these alone, the last one becomes the current robot
  bool contains(RobotId robot) const;
  std::vector<RobotId> robots() const;  // in the order of the list
  std::set<RobotId> ids() const { return {ids_.begin(), ids_.end()}; }
  std::optional<RobotId> current() const;

  void set_hidden(RobotId robot, bool hidden);
  bool is_hidden(RobotId robot) const { return hidden_.contains(robot); }
  const std::set<RobotId>& hidden() const { return hidden_; }

  // Forgets selected robots that are gone; LiveScene::frame() calls it.
  void update();

 private:
  const SceneDocument& document_;
  std::vector<RobotId> ids_;  // in the order of selection
  std::set<RobotId> hidden_;
};

}  // namespace mercury
