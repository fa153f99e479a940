// SPDX-License-Identifier: Apache-2.0
// The right half of the picture while there are two sides.
#pragma once

#include <cstdint>
#include <optional>

#include "app/live/live_scene.h"
#include "app/window/viewport/viewport.h"
#include "app/window/viewport/viewport_area.h"

namespace mercury::window {

class SecondView {
 public:
  explicit SecondView(render::Context& gl_context) : gl_context_(gl_context) {}

  // Splits the area while the scene has a second side. Returns the area of the first side. Call it once per frame.
  ViewportArea split(LiveScene& scene, const ViewportArea& whole);
  // Of the second side; none = there is one side.
  const std::optional<ViewportArea>& area() const { return area_; }
  // Whether the number of sides changed in this frame.
  bool changed() const { return changed_; }

  // Hands robots, quality and size to the renderer; `scale`: pixels of the framebuffer per pixel of the window. Returns
  // whether the robots changed.
  bool update(LiveScene& scene, render::Quality quality, ImVec2 scale);
  void draw(LiveScene& scene, const render::Camera& camera, bool moving);
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
