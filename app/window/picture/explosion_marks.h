// SPDX-License-Identifier: Apache-2.0
// The first bad spring of each robot that has exploded, drawn over the picture so that nothing hides it.
#pragma once

#include <optional>
#include <span>

#include "app/window/picture/desk.h"
#include "app/window/picture/hands.h"

namespace mercury::window {

struct ExplosionMarks {
  std::optional<RobotId> chosen;  // its figures are written; of the others the names, where there is room
  ImVec2 covered_low{0, 0}, covered_high{0, 0};  // nothing is written there
};

// Call between begin_frame() and end_frame(). `camera`: that of the picture.
void draw_explosion_marks(std::span<const ExplodedRobot> robots, const ExplosionMarks& marks,
                          Observations& observations, const PictureArea& area, const render::Camera& camera);

}  // namespace mercury::window
