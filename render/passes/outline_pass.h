// SPDX-License-Identifier: Apache-2.0
// The outline of selected bodies: a line around their silhouettes, outside of them, so that no color inside changes.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "render/context/gl_objects.h"
#include "render/passes/lattice_pass.h"
#include "render/passes/scene_buffers.h"
#include "render/scene.h"

namespace mercury::render {

// The textures of one picture.
struct Targets {
  Texture light, depth, picture;  // multisampled light and depth; the finished picture
  Texture bytes;                  // the same texels as the picture, not decoded
  Framebuffer drawing, finished;
};

inline Targets make_targets(int width, int height, int samples) {
  Targets t;
  t.light = make_texture(GL_RGBA16F, width, height, samples);
  t.depth = make_texture(GL_DEPTH_COMPONENT32F, width, height, samples);
  t.picture = make_texture(GL_SRGB8_ALPHA8, width, height);
  GLuint bytes = 0;
  glGenTextures(1, &bytes);
  t.bytes = Texture(bytes);
  glTextureView(bytes, GL_TEXTURE_2D, t.picture.get(), GL_RGBA8, 0, 1, 0, 1);
  t.drawing = make_framebuffer({t.light.get()}, t.depth.get());
  t.finished = make_framebuffer({t.picture.get()});
  return t;
}

// 1. Draws the depth of what is shown of the selected bodies, one sample per pixel. Where there is depth, they are.
// 2. Draws one rectangle per selected body, which covers its box in the picture and the line around it. Each pixel
//    outside the silhouettes looks for the nearest pixel inside, and is on the line if that is near enough and nothing
//    nearer to the eye covers it. The cost is that of the selected bodies and of their area in the picture.
class OutlinePass {
 public:
  OutlinePass();
  void resize(int width, int height);
  // Draws onto the finished picture. `bodies`: as they are drawn, perhaps finer. `boxes`: of BoundsPass. Does nothing
  // if no body is selected.
  void draw(const Bodies& bodies, const Scene& scene, LatticePass& lattice, const Buffer& boxes,
            const Targets& targets);

 private:
  void attach(const Bodies& bodies);
  void draw_depth(const Bodies& bodies, const Scene& scene, LatticePass& lattice,
                  std::span<const std::uint32_t> selected) const;
  void draw_lines(const Buffer& boxes, const Targets& targets, std::size_t count, float reach);

  VertexArray corners_, empty_;
  Program skin_, line_;
  StreamBuffer selected_;
  int width_ = 0, height_ = 0;
  Texture depth_, drawn_;  // made when first needed; `drawn_`: where the line has been drawn
  Framebuffer depth_framebuffer_, line_framebuffer_;
  GLuint picture_ = 0;  // of line_framebuffer_
};

}  // namespace mercury::render
