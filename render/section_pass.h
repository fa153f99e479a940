// SPDX-License-Identifier: Apache-2.0
// What bodies look like inside, where a plane cuts them.
#pragma once

#include "render/bodies.h"
#include "render/gl_objects.h"
#include "render/scene.h"

namespace mercury::render {

// A map of the picture's size of the cut's plane: each place takes the look of the spring nearest to it (a Voronoi
// diagram, drawn as Hoff et al. 1999 do).
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
