// SPDX-License-Identifier: Apache-2.0
// The robots of the scene: a list, commands on the selected robots, and new random robots.
#pragma once

#include "app/window/panels/panel.h"
#include "app/window/panels/robot_list.h"

namespace mercury::window {

// The part of the Robots panel that makes random robots: the settings of a generator (mercury/generator.h), and a
// button.
class RandomSection {
 public:
  void draw(PanelContext& context);
  // Height of its rows [pixels].
  float height(const PanelContext& context) const;

 private:
  bool advanced_ = false;  // show the advanced settings, too
};

class RobotsPanel : public Panel {
 public:
  void draw(PanelContext& context) override;

 private:
  void draw_commands(PanelContext& context);
  void draw_strengths(PanelContext& context);

  RobotList list_;
  RandomSection random_;
};

}  // namespace mercury::window
