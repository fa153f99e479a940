// SPDX-License-Identifier: Apache-2.0
// Clicks on rows of robots, as in a file manager.
#pragma once

#include <span>

#include "app/live/live_scene.h"

namespace mercury::window {

class RowSelection {
 public:
  // A plain click selects one robot. Shift-click selects all rows from the last one that was clicked, Ctrl-click adds
  // or removes one, and with both keys the range is added. `rows`: the robots in the order that the user sees.
  void click(LiveScene& scene, RobotId robot, std::span<const RobotId> rows);

 private:
  RobotId anchor_ = 0;  // where a range starts; 0 = nowhere
};

}  // namespace mercury::window
