// SPDX-License-Identifier: Apache-2.0
#include "render/ghost_pass.h"

#include <algorithm>
#include <vector>

#include "render/bindings.h"

namespace mercury::render {
namespace {

void append_corners(const Ghost& ghost, std::vector<Vector4>& corners) {
  for (const std::uint32_t mass : ghost.faces) {
    const float* p = ghost.positions.data() + 3 * std::size_t{mass};
    corners.push_back({p[0] + ghost.offset.x, p[1] + ghost.offset.y, p[2] + ghost.offset.z, 1});
  }
}

}  // namespace

GhostPass::GhostPass() : empty_(make_vertex_array()), program_(make_program({"ghost.vert", "ghost.frag"})) {}

void GhostPass::draw(std::span<const Ghost> ghosts) {
  std::vector<Vector4> corners;
  for (const Ghost& ghost : ghosts) append_corners(ghost, corners);
  if (corners.empty()) return;
  corners_.write(corners);
  corners_.bind_storage(binding::first_free);
  glUseProgram(program_.get());
  glBindVertexArray(empty_.get());
  glEnable(GL_CULL_FACE);
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(-2, -8);  // farther: depths are reversed
  const auto draw_all = [&] {
    GLint first = 0;
    for (const Ghost& ghost : ghosts) {
      const auto light = linear_of(ghost.color);
      glUniform4f(0, light[0], light[1], light[2], ghost.opacity);
      glDrawArrays(GL_TRIANGLES, first, GLsizei(ghost.faces.size()));
      first += GLint(ghost.faces.size());
    }
  };
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  draw_all();
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthMask(GL_FALSE);
  glDepthFunc(GL_EQUAL);
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
  draw_all();
  glDisable(GL_BLEND);
  glDepthFunc(GL_GREATER);
  glDepthMask(GL_TRUE);
  glDisable(GL_POLYGON_OFFSET_FILL);
  glDisable(GL_CULL_FACE);
}

}  // namespace mercury::render
