// SPDX-License-Identifier: Apache-2.0
// Drawings that explain the scene: arrows, paths, and particles that drift with the water.
#pragma once

#include "render/camera.h"
#include "render/gl_objects.h"
#include "render/scene.h"

namespace mercury::render {

class AnnotationPass {
 public:
  AnnotationPass();
  void draw_arrows(std::span<const Arrow> arrows);
  // Translucent: call them after everything solid, with the depth test on. Blending is off before and after.
  void draw_paths(std::span<const Path> paths, float width);
  // Two sets of particles, one of twice the size, fade into each other as the camera's distance changes.
  void draw_particles(const Scene& scene, const Camera& camera, int count) const;

 private:
  void draw_particles(const Scene& scene, const Camera& camera, int count, float half_side, float share) const;

  VertexArray empty_;
  Program arrow_, path_, particle_;
  StreamBuffer arrows_, points_;
};

}  // namespace mercury::render
