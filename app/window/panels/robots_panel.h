// SPDX-License-Identifier: Apache-2.0
// The robots of the scene: list, changes, and the making of random ones.
#pragma once

#include <string>

#include "app/window/panels/random_panel.h"
#include "app/window/picture/desk.h"

namespace mercury::window {

class RobotsPanel {
 public:
  void draw(Desk& desk, float aspect);
  void mutate(Desk& desk);

  RandomPanel random;

 private:
  void draw_list(Desk& desk, float aspect);
  void draw_row(Desk& desk, const RobotEntry& entry, float aspect);
  void choose(Desk& desk, const RobotEntry& entry);
  void draw_changes(Desk& desk);

  Mutation mutation_;
  RobotId anchor_ = 0;  // where a range of selected rows begins
};

}  // namespace mercury::window
