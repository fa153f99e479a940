// SPDX-License-Identifier: Apache-2.0
// The right half of the view while there are two sides, and what stands over the view while robots are compared:
// a title over each side, and how robots do against their ghosts.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "app/live/live_scene.h"
#include "app/live/scene_comparison.h"
#include "app/window/toolkit/event_log.h"
#include "app/window/viewport/viewport.h"

namespace mercury::window {

// The two halves of an area, the left one first, with a gap between them.
struct Halves {
  ViewportArea first, second;
};
Halves halves_of(const ViewportArea& area);

// Names each side by what differs, at the top of its half. Returns the height that the titles take [pixels].
float draw_side_titles(const LiveScene& scene, const Halves& halves, EventLog& log);

// A line of text below each robot that has a ghost: how much farther and faster it is.
// `top`: of the area that is taken [pixels].
void draw_ghost_figures(LiveScene& scene, const ViewportArea& area, float top, const render::Camera& camera,
                        EventLog& log);

// "+12 cm (+8 %)\n+3 cm/s to its parent": two lines, or one.
std::string text_of(const GhostFigures& figures);

class SecondView {
 public:
  explicit SecondView(render::Context& gl_context) : gl_context_(gl_context) {}

  // Splits the area while the scene has a second side. Returns the area of the first side. Call it once per frame.
  ViewportArea split(LiveScene& scene, const ViewportArea& whole);
  // Of the second side; none = there is one side.
  const std::optional<ViewportArea>& area() const { return area_; }
  // Whether the number of sides changed in this frame.
  bool changed() const { return changed_; }

  // `scale`: pixels of the framebuffer per pixel of the window.
  void place(ImVec2 scale);
  // Hands robots and quality to the renderer. Returns whether the robots changed.
  bool update(LiveScene& scene, render::Quality quality);
  void draw(LiveScene& scene, const render::Camera& camera, bool moving);
  void finish();
  void present(int framebuffer_height) const;
  bool coarse() const { return viewport_ && viewport_->coarse(); }

 private:
  render::Context& gl_context_;
  std::optional<ViewportArea> area_;
  std::optional<Viewport> viewport_;
  std::uint64_t revision_ = 0;  // of the bodies that the renderer has
  bool changed_ = false;
};

}  // namespace mercury::window
