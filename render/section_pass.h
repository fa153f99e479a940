// SPDX-License-Identifier: Apache-2.0
// The inside of bodies where a plane cuts them.
#pragma once

#include "render/bodies.h"
#include "render/gl_objects.h"
#include "render/scene.h"

namespace mercury::render {

// Draws a map of the cut's plane at the picture's size: each point takes the material, or the value's colour, of the
// nearest spring. This is a Voronoi diagram, drawn with the depth test as in Hoff et al. 1999: each spring draws a
// square whose depth is the distance to the spring's middle, and the nearest wins.
class SectionPass {
 public:
  SectionPass();
  void resize(int width, int height);
  // Draws the map and binds it for the skins. Uses the buffers bound for the skins and the colour maps.
  void draw(const Bodies& bodies, const Scene& scene);

 private:
  VertexArray empty_;
  Program program_;
  int width_ = 0, height_ = 0;
  Texture colors_, nearness_;  // made when first needed
  Framebuffer framebuffer_;
};

}  // namespace mercury::render
