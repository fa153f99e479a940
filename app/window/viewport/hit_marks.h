// SPDX-License-Identifier: Apache-2.0
// What is under the mouse: its mass and spring are marked on the picture, and their figures stand beside it.
#pragma once

#include "app/live/live_scene.h"
#include "app/window/toolkit/event_log.h"
#include "app/window/viewport/viewport_area.h"
#include "render/camera.h"

namespace mercury::window {

// Marks the mass and the spring of a hit on the picture, over everything else. Does nothing if the robot is gone. Call
// between begin_frame() and end_frame() of ImGuiLayer. `camera`: the one the picture was drawn with. Returns where the
// mass is in the window, if it is in front of the camera.
std::optional<ImVec2> draw_hit_mark(LiveScene& scene, const Hit& hit, const ViewportArea& area,
                                    const render::Camera& camera);

// The figures of a hit, as lines of the present ImGui window.
void write_figures(const LiveScene& scene, const Hit& hit);

// How high a tooltip with all figures is [pixels].
float figures_height();

// A small window with the figures, beside the mass and, where possible, beside the legend. Returns false once the user
// closes it, or the robot is gone.
bool draw_pinned_figures(LiveScene& scene, const Hit& hit, EventLog& log, const ViewportArea& area,
                         const render::Camera& camera, const Box& legend);

}  // namespace mercury::window
