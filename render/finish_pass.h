// SPDX-License-Identifier: Apache-2.0
// From samples of light to the finished picture: spreads the glow, applies the tone curve, averages the samples.
#pragma once

#include "render/fullscreen.h"
#include "render/quality.h"

namespace mercury::render {

class FinishPass {
 public:
  explicit FinishPass(const QualitySettings& settings);
  void resize(int width, int height);
  // `samples`: multisampled light; its alpha is the share that glows. Writes gamma-encoded bytes to `picture` (RGBA8).
  void draw(GLuint samples, GLuint picture, float vignette) const;

 private:
  int width_ = 0, height_ = 0, glow_width_ = 0, glow_height_ = 0;
  Texture glow_, across_;
  Framebuffer glow_framebuffer_, across_framebuffer_;
  Fullscreen extract_, blur_;
  Program resolve_;
};

}  // namespace mercury::render
