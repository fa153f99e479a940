// SPDX-License-Identifier: Apache-2.0
// The part of the Tune panel that changes the materials of the selected robots, or of all.
#pragma once

#include "app/window/panels/panel_context.h"

namespace mercury::window {

class MaterialsSection {
 public:
  void draw(PanelContext& context);

 private:
  void draw_factors(PanelContext& context, const std::vector<RobotId>& robots);
  void draw_one(PanelContext& context, const std::vector<RobotId>& robots);

  MaterialScale scale_;
  int material_ = 1;
};

}  // namespace mercury::window
