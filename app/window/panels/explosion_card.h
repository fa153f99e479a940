// SPDX-License-Identifier: Apache-2.0
// What robots that have exploded are told with: which and when, the spring that went first, and what can be done.
#pragma once

#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "app/window/panels/panel_context.h"
#include "app/window/viewport/viewport_area.h"

namespace mercury::window {

class ExplosionCard {
 public:
  // Takes note of explosions and marks their springs in the picture that `camera` was used for; call once a frame,
  // before what lies over the picture.
  void follow(PanelContext& context, const ViewportArea& area, const render::Camera& camera);
  // Over the lower left of the picture, while there is one to tell of.
  void draw(PanelContext& context, const ViewportArea& area);

 private:
  const ExplodedRobot* chosen() const;
  void choose(int places);
  void draw_heading(PanelContext& context, const ExplodedRobot& robot);
  void draw_buttons(PanelContext& context, const ExplodedRobot& robot, const ViewportArea& area);

  std::vector<ExplodedRobot> robots_;
  std::optional<RobotId> chosen_;
  ImVec2 low_{0, 0}, high_{0, 0};                   // of the card; empty = it is not shown
  std::set<std::pair<RobotId, double>> dismissed_;  // explosions that need not be told of any more
};

}  // namespace mercury::window
