// SPDX-License-Identifier: Apache-2.0
// Where planes cut bodies: the planes, and the inside that they show.
#pragma once

#include "render/context/gl_objects.h"
#include "render/passes/scene_buffers.h"
#include "render/scene.h"

namespace mercury::render {

// The plane that cuts each body, computed from the positions on the GPU.
class CutPass {
 public:
  CutPass();
  // Writes the planes into the placements that are bound (Placement of shaders/bodies.glsl).
  void find(Bodies& bodies, const Cut& cut) const;

 private:
  Program program_;
};

// Draws a map of the cuts' planes at the picture's size: each point takes the material, or the value's color, of the
// nearest spring of the body that is cut there. This is a Voronoi diagram, drawn with the depth test as in Hoff et al.
// 1999: each spring draws a triangle whose depth is the distance to the spring's middle, and the nearest wins.
class SectionPass {
 public:
  SectionPass();
  void resize(int width, int height);
  // First: finds where insides are seen (shaders/cut_map.glsl), and binds that map. `surfaces`: draws the skins behind
  // the planes with their depth, and backs with the number of their body (surface.frag).
  template <typename Surfaces>
  void find(Surfaces surfaces) {
    begin();
    surfaces();
    bind();
  }
  // Draws the map of colors and binds both for the skins. Uses the buffers bound for the skins and the color maps.
  void draw(const Bodies& bodies, const Scene& scene);

 private:
  void begin();
  void bind() const;

  VertexArray empty_;
  Program program_;
  int width_ = 0, height_ = 0;
  Texture colors_, bodies_, nearness_;  // made when first needed
  Framebuffer framebuffer_, bodies_framebuffer_;
};

}  // namespace mercury::render
