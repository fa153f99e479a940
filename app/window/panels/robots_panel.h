// SPDX-License-Identifier: Apache-2.0
// The robots of the scene: list, changes, and the making of random ones.
#pragma once

#include <string>

#include "app/window/panels/panel_context.h"
#include "app/window/panels/random_panel.h"

namespace mercury::window {

class RobotsPanel {
 public:
  void draw(PanelContext& context, float aspect);
  void mutate(PanelContext& context);

  RandomPanel random;

 private:
  void draw_list(PanelContext& context, float aspect);
  void draw_row(PanelContext& context, const RobotEntry& entry, float aspect);
  void choose(PanelContext& context, const RobotEntry& entry);
  void draw_changes(PanelContext& context);

  MutationRequest mutation_;
  RobotId anchor_ = 0;  // where a range of selected rows begins
};

}  // namespace mercury::window
