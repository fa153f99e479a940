// SPDX-License-Identifier: Apache-2.0
// The 3D picture in its part of the window, drawn so that the window stays quick whatever a picture costs.
#pragma once

#include <imgui.h>

#include "render/renderer.h"

namespace mercury::window {

class Viewport {
 public:
  Viewport(render::Context& gl_context, render::Quality quality);

  // Where it is to be, in the framebuffer's pixels from the upper left corner.
  void place(int x, int y, int width, int height);
  float aspect() const { return static_cast<float>(width_) / static_cast<float>(height_); }

  // Draws the scene; `moving` = more pictures follow at once, so that a slow one may be coarser.
  void draw(const render::Scene& scene, const render::Camera& camera, bool moving);
  // Copies the last picture into the window's framebuffer of that height.
  void present(int framebuffer_height) const;

  render::Renderer& renderer() { return renderer_; }
  const render::Renderer& renderer() const { return renderer_; }
  double draw_seconds() const { return draw_seconds_; }  // of the last picture, waiting for the card included
  float share() const { return share_; }                 // of the pixels across and down that were drawn
  // Whether a finer picture can be had now that nothing moves.
  bool coarse() const { return share_ < 1; }

 private:
  void adapt(bool moving);

  render::Renderer renderer_;
  bool software_;
  int x_ = 0, y_ = 0, width_ = 64, height_ = 64;
  float share_ = 1, moving_share_ = 1;
  double draw_seconds_ = 0;
};

}  // namespace mercury::window
