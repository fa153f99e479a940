// SPDX-License-Identifier: Apache-2.0
// Materials of the chosen robots, as sliders that act at once.
#pragma once

#include "app/window/panels/panel_context.h"

namespace mercury::window {

class MaterialsPanel {
 public:
  void draw(PanelContext& context);

 private:
  void draw_factors(PanelContext& context, const std::vector<RobotId>& robots);
  void draw_one(PanelContext& context, const std::vector<RobotId>& robots);

  MaterialScale scale_;
  int material_ = 1;
};

}  // namespace mercury::window
