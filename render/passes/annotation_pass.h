// SPDX-License-Identifier: Apache-2.0
// Drawings that explain the scene: tiles, arrows, paths, and particles that drift with the water.
#pragma once

#include <string>

#include "render/camera.h"
#include "render/context/gl_objects.h"
#include "render/scene.h"
#include "render/text/overlay.h"

namespace mercury::render {

class AnnotationPass {
 public:
  // `defines`: of the samples of soft shadows (QualitySettings).
  explicit AnnotationPass(const std::string& defines);
  void draw_arrows(std::span<const Arrow> arrows);
  // Translucent: call them after everything solid, with the depth test on. Blending is off before and after.
  void draw_tiles(std::span<const Tile> tiles);
  void draw_paths(std::span<const Path> paths, float width);
  // Two sets of particles, one of twice the size, fade into each other as the camera's distance changes.
  void draw_particles(const Scene& scene, const Camera& camera, int count);

 private:
  void draw_particles(const Scene& scene, const Camera& camera, int count, float half_side, float share);

  VertexArray empty_;
  Program arrow_, path_, particle_, tile_;
  StreamBuffer arrows_, points_, tiles_;
  StreamBuffer particles_;  // at most two sets per picture
};

// Paints an Overlay onto a finished picture.
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
