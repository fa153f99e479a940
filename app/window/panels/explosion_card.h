// SPDX-License-Identifier: Apache-2.0
// What robots that have exploded are told with: which and when, the spring that went first, and what can be done.
#pragma once

#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "app/window/picture/desk.h"
#include "app/window/picture/hands.h"

namespace mercury::window {

class ExplosionCard {
 public:
  // Takes note of explosions and marks their springs in the picture that `camera` was used for; call once a frame,
  // before what lies over the picture.
  void follow(Desk& desk, const PictureArea& area, const render::Camera& camera);
  // Over the lower left of the picture, while there is one to tell of.
  void draw(Desk& desk, const PictureArea& area);

 private:
  const ExplodedRobot* chosen() const;
  void choose(int places);
  void draw_heading(Desk& desk, const ExplodedRobot& robot);
  void draw_buttons(Desk& desk, const ExplodedRobot& robot, const PictureArea& area);

  std::vector<ExplodedRobot> robots_;
  std::optional<RobotId> chosen_;
  ImVec2 low_{0, 0}, high_{0, 0};                   // of the card; empty = it is not shown
  std::set<std::pair<RobotId, double>> dismissed_;  // explosions that need not be told of any more
};

}  // namespace mercury::window
