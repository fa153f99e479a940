// SPDX-License-Identifier: Apache-2.0
// The robots of the scene: a list, commands on the selected robots, and new random robots.
#pragma once

#include "app/window/panels/panel.h"
#include "app/window/panels/random_section.h"

namespace mercury::window {

class RobotsPanel : public Panel {
 public:
  void draw(PanelContext& context) override;

 private:
  void draw_list(PanelContext& context);
  void draw_row(PanelContext& context, const RobotEntry& entry);
  void select(PanelContext& context, const RobotEntry& entry);
  void draw_commands(PanelContext& context);

  RandomSection random_;
  RobotId anchor_ = 0;  // the robot at which a Shift-click range starts; 0 = none
};

}  // namespace mercury::window
