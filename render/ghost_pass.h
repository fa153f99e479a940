// SPDX-License-Identifier: Apache-2.0
// Ghosts: translucent bodies in one color, over everything else.
#pragma once

#include <span>

#include "render/gl_objects.h"
#include "render/scene.h"

namespace mercury::render {

class GhostPass {
 public:
  GhostPass();
  // Call it last of all that has a depth, with the depth test on. A ghost is hidden by what is nearer, and where it
  // coincides with a body. Its own depth is written first, so that each pixel shows its nearest face only.
  void draw(std::span<const Ghost> ghosts);

 private:
  VertexArray empty_;
  Program program_;
  StreamBuffer corners_;
};

}  // namespace mercury::render
