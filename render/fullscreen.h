// Passes that cover a whole picture.
#pragma once

#include "render/gl_objects.h"

namespace mercury::render {

// fullscreen.vert with a fragment shader of its own.
class Fullscreen {
 public:
  Fullscreen(std::string_view fragment_shader, const std::string& defines = "");
  GLuint program() const { return program_.get(); }
  // Into the framebuffer bound now.
  void draw() const;
  // Into all of that framebuffer, without depth test.
  void draw_into(GLuint framebuffer, int width, int height) const;

 private:
  VertexArray empty_;
  Program program_;
};

}  // namespace mercury::render
