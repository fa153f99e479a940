// SPDX-License-Identifier: Apache-2.0
// The first bad spring of each robot that has exploded, drawn over the picture so that nothing hides it.
#pragma once

#include <optional>
#include <span>

#include "app/live/live_scene.h"
#include "app/window/toolkit/event_log.h"
#include "app/window/viewport/viewport_area.h"
#include "render/camera.h"

namespace mercury::window {

struct ExplosionMarks {
  std::optional<RobotId> chosen;  // its figures are written; of the others the names, where there is room
  ImVec2 covered_low{0, 0}, covered_high{0, 0};  // nothing is written there
};

// Call between begin_frame() and end_frame(). `camera`: that of the picture.
void draw_explosion_marks(std::span<const ExplodedRobot> robots, const ExplosionMarks& marks, EventLog& log,
                          const ViewportArea& area, const render::Camera& camera);

}  // namespace mercury::window
