// SPDX-License-Identifier: Apache-2.0
// A card over the view for robots that exploded: which robot and when, its culprit spring, and what to do about it.
#pragma once

#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "app/window/panels/panel.h"
#include "app/window/viewport/viewport.h"

namespace mercury::window {

class ExplosionCard {
 public:
  // Takes over new explosions and marks the culprit spring of one robot in the view: of the one that was selected or
  // chosen last. `camera` is the one the view was drawn with. Call once per frame, before draw().
  void update(PanelContext& context, const ViewportArea& area, const render::Camera& camera);
  // Draws the card at the lower left of the view, if there is an explosion that was not dismissed.
  void draw(PanelContext& context, const ViewportArea& area);
  Box box() const { return {low_, high_}; }                 // of the card; empty = not shown
  const std::vector<Box>& marks() const { return marks_; }  // the spring's ends and text in the view

 private:
  const ExplodedRobot* chosen() const;
  void choose(int steps);  // moves on to another robot
  void draw_heading(PanelContext& context, const ExplodedRobot& robot);
  void draw_buttons(PanelContext& context, const ExplodedRobot& robot, const ViewportArea& area);

  std::vector<ExplodedRobot> robots_;
  std::optional<RobotId> chosen_, selected_;  // selected_: when the last frame was drawn
  ImVec2 low_{0, 0}, high_{0, 0};             // the card's rectangle; empty = not shown
  std::vector<Box> marks_;
  std::set<std::pair<RobotId, double>> dismissed_;  // explosions that the user dismissed
};

}  // namespace mercury::window
