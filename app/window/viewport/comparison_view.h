// SPDX-License-Identifier: Apache-2.0
// What stands over the picture while robots are compared: a title over each side, and how robots do against their
// ghosts.
#pragma once

#include <string>

#include "app/live/live_scene.h"
#include "app/window/toolkit/event_log.h"
#include "app/window/viewport/viewport_area.h"

namespace mercury::window {

// The two halves of an area, the left one first, with a gap between them.
struct Halves {
  ViewportArea first, second;
};
Halves halves_of(const ViewportArea& area);

// Names each side by what differs, at the top of its half. Returns the height that the titles take [pixels].
float draw_side_titles(const LiveScene& scene, const Halves& halves, EventLog& log);

// A line of text below each robot that has a ghost: how much farther and faster it is.
void draw_ghost_figures(LiveScene& scene, const ViewportArea& area, const render::Camera& camera, EventLog& log);

// "+12 cm (+8 %)\n+3 cm/s to its parent": two lines, or one.
std::string text_of(const GhostFigures& figures);

}  // namespace mercury::window
