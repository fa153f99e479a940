// SPDX-License-Identifier: Apache-2.0
#include "render/cull_pass.h"

#include <algorithm>

#include "render/bindings.h"
#include "render/program_variants.h"

namespace mercury::render {
namespace {

constexpr std::size_t faces_per_group = 256;
constexpr std::size_t command_bytes = 20;  // DrawElementsIndirectCommand

}  // namespace

CullPass::CullPass()
    : stages_{make_program({"cull.comp"}, define("STAGE", 0)), make_program({"cull.comp"}, define("STAGE", 1)),
              make_program({"cull.comp"}, define("STAGE", 2))} {}

void CullPass::attach(const Bodies& bodies) {
  const std::size_t faces = bodies.face_count();
  counts_.reserve(8 * ((faces + faces_per_group - 1) / faces_per_group));
  commands_.reserve(2 * command_bytes);
  seen_corners_.reserve(12 * faces);
  lit_corners_.reserve(12 * faces);
  seen_faces_.reserve(4 * faces);
}

void CullPass::find(const Bodies& bodies, bool all_sides) {
  any_ = bodies.face_count() > 0;
  if (!any_) return;
  bodies.faces.bind_storage(binding::faces);
  counts_.bind_storage(binding::first_free);
  commands_.bind_storage(binding::first_free + 1);
  seen_corners_.bind_storage(binding::first_free + 2);
  lit_corners_.bind_storage(binding::first_free + 3);
  seen_faces_.bind_storage(binding::seen_faces);
  const GLuint groups = GLuint((bodies.face_count() + faces_per_group - 1) / faces_per_group);
  const GLuint across = std::min(groups, 32768u);
  for (std::size_t stage = 0; stage < stages_.size(); ++stage) {
    glUseProgram(stages_[stage].get());
    glUniform1ui(1, groups);
    if (stage != 1) {
      glUniform1ui(0, GLuint(bodies.face_count()));
      glUniform1i(2, all_sides ? 1 : 0);
    }
    stage == 1 ? glDispatchCompute(1, 1, 1) : glDispatchCompute(across, (groups + across - 1) / across, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_ELEMENT_ARRAY_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
  }
}

void CullPass::bind_seen() const {
  commands_.bind_storage(binding::first_free + 1);
  seen_faces_.bind_storage(binding::seen_faces);
}

void CullPass::draw_seen(GLuint vertex_array) const { draw(vertex_array, seen_corners_, 0); }
void CullPass::draw_lit(GLuint vertex_array) const { draw(vertex_array, lit_corners_, 1); }

void CullPass::draw(GLuint vertex_array, const Buffer& corners, std::size_t command) const {
  if (!any_) return;
  glVertexArrayElementBuffer(vertex_array, corners.get());
  glBindVertexArray(vertex_array);
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, commands_.get());
  glDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_INT, reinterpret_cast<const void*>(command * command_bytes));
}

}  // namespace mercury::render
