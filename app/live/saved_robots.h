// SPDX-License-Identifier: Apache-2.0
// The robots as their files hold them. A robot of the scene is saved if both are equal.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>

#include "app/live/snapshot.h"

namespace mercury {

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

}  // namespace mercury
