// SPDX-License-Identifier: Apache-2.0
// The textures of one picture.
#pragma once

#include "render/gl_objects.h"

namespace mercury::render {

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

}  // namespace mercury::render
