// SPDX-License-Identifier: Apache-2.0
// Paints an Overlay onto a finished picture.
#pragma once

#include "render/gl_objects.h"
#include "render/overlay.h"

namespace mercury::render {

class OverlayPass {
 public:
  OverlayPass();
  // `colormaps`: a texture with one map per row. Draws into an sRGB framebuffer.
  void draw(const Overlay& overlay, GLuint framebuffer, int width, int height, GLuint colormaps);

 private:
  VertexArray empty_;
  Program program_;
  StreamBuffer quads_;
  Texture atlas_;
};

}  // namespace mercury::render
