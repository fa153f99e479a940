// SPDX-License-Identifier: Apache-2.0
// Ambient occlusion: how much of the sky's light reaches each point of the picture, at half the picture's size.
#pragma once

#include "render/gl_objects.h"
#include "render/quality.h"

namespace mercury::render {

class OcclusionPass {
 public:
  explicit OcclusionPass(const QualitySettings& settings);
  void resize(int width, int height);  // of the picture

  // `depths`: of FrontPass. `radius`: surfaces farther apart do not darken each other [m]. Binds its result.
  void draw(GLuint depths, float radius) const;

 private:
  int width_ = 0, height_ = 0;
  Texture rough_, smooth_;
  Program occlusion_, blur_;
};

}  // namespace mercury::render
