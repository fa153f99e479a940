// SPDX-License-Identifier: Apache-2.0
// Passes that cover a whole picture.
#pragma once

#include "render/program_variants.h"

namespace mercury::render {

// fullscreen.vert with a given fragment shader.
class Fullscreen {
 public:
  Fullscreen(std::string_view fragment_shader, const std::string& defines = "");
  GLuint program(const std::string& variant = "") const { return program_.get(variant); }
  // Draws into the bound framebuffer.
  void draw(const std::string& variant = "") const;
  // Draws into all of that framebuffer, without depth test.
  void draw_into(GLuint framebuffer, int width, int height) const;

 private:
  VertexArray empty_;
  ProgramVariants program_;
};

}  // namespace mercury::render
