// SPDX-License-Identifier: Apache-2.0
// The 3D view of the robots, in its part of the window.
//
// The window must react quickly even if drawing is slow, as in software rendering. While the view moves, it is
// therefore drawn with fewer pixels if the last one took too long, and enlarged to its area; once it rests, it is drawn
// with all pixels.
#pragma once

#include <imgui.h>

#include "render/renderer.h"

namespace mercury::window {

// The part of the window that shows the robots, in ImGui's coordinates: pixels from the upper left corner of the
// window.
struct ViewportArea {
  ImVec2 low, high;
  float width() const { return high.x - low.x; }
  float height() const { return high.y - low.y; }
  float aspect() const { return width() / height(); }
  bool holds(ImVec2 p) const { return p.x >= low.x && p.x < high.x && p.y >= low.y && p.y < high.y; }
};

// Where a point of the scene is on the screen.
ImVec2 on_screen(const ViewportArea& area, const render::Camera& camera, const render::Vector3& point);

// A part of it that something is drawn over; empty = nothing.
struct Box {
  ImVec2 low{0, 0}, high{0, 0};
  bool empty() const { return high.x <= low.x || high.y <= low.y; }
  bool meets(const Box& other) const {
    return low.x < other.high.x && other.low.x < high.x && low.y < other.high.y && other.low.y < high.y;
  }
  bool holds(ImVec2 point) const { return meets({point, {point.x + 1, point.y + 1}}); }
};

class Viewport {
 public:
  Viewport(render::Context& gl_context, render::Quality quality);

  // Sets the area, in pixels of the framebuffer from the upper left corner.
  void place(int x, int y, int width, int height);
  float aspect() const { return static_cast<float>(width_) / static_cast<float>(height_); }

  // Begins to draw the scene. `moving`: the next frame follows at once, so this one may be coarse.
  void draw(const render::Scene& scene, const render::Camera& camera, bool moving);
  // Waits until the scene is drawn. Whatever the caller does in between, the GPU draws meanwhile.
  void finish();
  // Copies the last frame into the window's framebuffer, which has this height [pixels].
  void present(int framebuffer_height) const;

  render::Renderer& renderer() { return renderer_; }
  const render::Renderer& renderer() const { return renderer_; }
  float share() const { return share_; }  // of the area's width and height that was drawn, 0.5 to 1
  // True if the last frame had reduced resolution.
  bool coarse() const { return share_ < 1; }

 private:
  void adapt(bool moving);

  render::Renderer renderer_;
  bool software_;
  int x_ = 0, y_ = 0, width_ = 64, height_ = 64;
  float share_ = 1, moving_share_ = 1;
  double begun_ = 0;  // wall time [s]
  bool drawing_ = false;
  double draw_seconds_ = 0;  // of the last frame, from draw() to the end of finish()
};

}  // namespace mercury::window
