// Ambient occlusion: how much of the sky's light each point of the picture sees, computed at half its size.
#pragma once

#include "render/fullscreen.h"
#include "render/quality.h"

namespace mercury::render {

class OcclusionPass {
 public:
  explicit OcclusionPass(const QualitySettings& settings);
  void resize(int width, int height);  // of the picture

  // `radius`: how far away things darken [m]. `depth`: draws what occludes, depth alone, besides the floor.
  template <typename Depth>
  void draw(float radius, Depth depth) {
    begin_depth();
    depth();
    draw_maps(radius);
  }

 private:
  void begin_depth();
  void draw_maps(float radius);

  int width_ = 0, height_ = 0;
  Texture depths_, rough_, smooth_;
  Framebuffer depth_framebuffer_, rough_framebuffer_, smooth_framebuffer_;
  Fullscreen floor_depth_, occlusion_, blur_;
};

}  // namespace mercury::render
