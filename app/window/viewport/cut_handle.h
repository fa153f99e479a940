// SPDX-License-Identifier: Apache-2.0
// A handle in the picture that moves the planes which cut the robots open.
#pragma once

#include "app/live/live_scene.h"
#include "app/window/toolkit/event_log.h"
#include "app/window/viewport/viewport_area.h"
#include "render/camera.h"

namespace mercury::window {

class CutHandle {
 public:
  // Draws the handle on the plane of the first selected robot, or of the first one that is visible, and a line along
  // which it moves, from that robot's one end to the other. Returns true if the mouse moved the planes in `view`. Call
  // between begin_frame() and end_frame() of ImGuiLayer. `camera`: the one the picture was drawn with.
  bool draw(LiveScene& scene, const ViewportArea& area, const render::Camera& camera, ViewSettings& view,
            EventLog& log) const;
};

}  // namespace mercury::window
