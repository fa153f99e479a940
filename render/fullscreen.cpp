// SPDX-License-Identifier: Apache-2.0
#include "render/fullscreen.h"

namespace mercury::render {

Fullscreen::Fullscreen(std::string_view fragment_shader, const std::string& defines)
    : empty_(make_vertex_array()), program_({"fullscreen.vert", fragment_shader}, defines) {}

void Fullscreen::draw(const std::string& variant) const {
  glUseProgram(program_.get(variant));
  glBindVertexArray(empty_.get());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

void Fullscreen::draw_into(GLuint framebuffer, int width, int height) const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glViewport(0, 0, width, height);
  glDisable(GL_DEPTH_TEST);
  draw();
}

}  // namespace mercury::render
