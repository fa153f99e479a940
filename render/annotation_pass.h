// SPDX-License-Identifier: Apache-2.0
// What is drawn into the scene to explain it: arrows, paths, and specks that show how the water flows.
#pragma once

#include "render/camera.h"
#include "render/gl_objects.h"
#include "render/scene.h"

namespace mercury::render {

class AnnotationPass {
 public:
  AnnotationPass();
  void draw_arrows(std::span<const Arrow> arrows);
  // Translucent: after everything solid, with the depth test on and blending left as it was found, off.
  void draw_paths(std::span<const Path> paths, float width);
  void draw_particles(const Scene& scene, const Camera& camera, int count) const;

 private:
  void draw_particles(const Scene& scene, const Camera& camera, int count, float half_side, float share) const;

  VertexArray empty_;
  Program arrow_, path_, particle_;
  StreamBuffer arrows_, points_;
};

}  // namespace mercury::render
