// SPDX-License-Identifier: Apache-2.0
// Marks on the view: of what is under the mouse, with its figures beside it, of springs that made robots explode,
// and the handle of the cut.
#pragma once

#include <optional>
#include <span>

#include "app/live/live_scene.h"
#include "app/live/picking.h"
#include "app/window/toolkit/event_log.h"
#include "app/window/viewport/viewport.h"
#include "render/camera.h"

namespace mercury::window {

// Marks the mass and the spring of a hit on the view, over everything else. Does nothing if the robot is gone. Call
// between begin_frame() and end_frame() of ImGuiLayer. `camera`: the one the view was drawn with. Returns where the
// mass is in the window, if it is in front of the camera.
std::optional<ImVec2> draw_hit_mark(LiveScene& scene, const Hit& hit, const ViewportArea& area,
                                    const render::Camera& camera);

// The figures of a hit, as lines of the current ImGui window.
void write_figures(const LiveScene& scene, const Hit& hit);

float figures_height();  // of all of them [pixels]

// A handle in the view that moves the planes which cut the robots open.
class CutHandle {
 public:
  // Draws the handle on the plane of the first selected robot, or of the first one that is visible, and a line along
  // which it moves, from that robot's one end to the other. Returns true if the mouse moved the planes in `view`. Call
  // between begin_frame() and end_frame() of ImGuiLayer. `camera`: the one the view was drawn with.
  bool draw(LiveScene& scene, const ViewportArea& area, const render::Camera& camera, ViewSettings& view,
            EventLog& log) const;
};

// A handle in the view that moves the target that brains seek.
class TargetHandle {
 public:
  // Draws the handle on the target of the first selected robot that seeks it, or of the first one that is visible; none
  // in cells, which have no place for it. The mouse moves it level with itself, with Shift up and down, and robots
  // follow at once. Call it as CutHandle::draw().
  void draw(LiveScene& scene, const ViewportArea& area, const render::Camera& camera, EventLog& log) const;

 private:
  // `target`: where it is drawn, by `offset` from where it is.
  static void move_to_mouse(LiveScene& scene, const ViewportArea& area, const render::Camera& camera,
                            const render::Vector3& target, const render::Vector3& offset);
};

// Draws the body of a robot that a spring tore apart, as it was built, in thin lines, and in it marks that spring with
// details in words, over the view, so that nothing hides it. The text covers none of the boxes `covered`. Returns what
// names should leave free: the spring's ends, and the text if there is room for it. Call between begin_frame() and
// end_frame() of ImGuiLayer. `camera`: the one the view was drawn with.
std::vector<Box> draw_explosion_mark(const ExplodedRobot& robot, std::span<const Box> covered, EventLog& log,
                                     const ViewportArea& area, const render::Camera& camera);

}  // namespace mercury::window
