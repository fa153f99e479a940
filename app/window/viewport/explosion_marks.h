// SPDX-License-Identifier: Apache-2.0
// Marks the culprit spring of each robot that exploded. Drawn over the picture, so that nothing hides it.
#pragma once

#include <optional>
#include <span>

#include "app/live/live_scene.h"
#include "app/window/toolkit/event_log.h"
#include "app/window/viewport/viewport_area.h"
#include "render/camera.h"

namespace mercury::window {

struct ExplosionMarks {
  std::optional<RobotId> chosen;                 // shown with details; the others only with their names
  ImVec2 covered_low{0, 0}, covered_high{0, 0};  // no text in this rectangle
};

// Call between begin_frame() and end_frame() of ImGuiLayer. `camera`: the one the picture was drawn with.
void draw_explosion_marks(std::span<const ExplodedRobot> robots, const ExplosionMarks& marks, EventLog& log,
                          const ViewportArea& area, const render::Camera& camera);

}  // namespace mercury::window
