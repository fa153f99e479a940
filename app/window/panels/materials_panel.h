// SPDX-License-Identifier: Apache-2.0
// Materials of the chosen robots, as sliders that act at once.
#pragma once

#include "app/window/picture/desk.h"

namespace mercury::window {

class MaterialsPanel {
 public:
  void draw(Desk& desk);

 private:
  void draw_factors(Desk& desk, const std::vector<RobotId>& robots);
  void draw_one(Desk& desk, const std::vector<RobotId>& robots);

  MaterialScale scale_;
  int material_ = 1;
};

}  // namespace mercury::window
