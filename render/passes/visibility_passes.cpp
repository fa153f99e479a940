// SPDX-License-Identifier: Apache-2.0
#include "render/passes/visibility_passes.h"

#include <algorithm>
#include <cstring>

#include "render/context/programs.h"
#include "render/passes/bindings.h"

namespace mercury::render {
namespace {

constexpr std::size_t faces_per_group = 256;
constexpr std::size_t command_bytes = 20;  // DrawElementsIndirectCommand

constexpr std::size_t box_bytes = 32;

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

BoundsPass::BoundsPass() : program_(make_program({"body_bounds.comp"})) {}

void BoundsPass::measure(const Bodies& bodies) {
  count_ = bodies.body_count();
  if (count_ == 0) return;
  boxes_.reserve(box_bytes * count_);
  boxes_.bind_storage(binding::first_free);
  bodies.first_masses.bind_storage(binding::first_free + 1);
  glUseProgram(program_.get());
  glDispatchCompute(GLuint(count_), 1, 1);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

void BoundsPass::start_reading() {
  if (count_ == 0) return;
  if (copy_.size() < box_bytes * count_) copy_ = HostBuffer(box_bytes * count_);
  copy_.start(boxes_, box_bytes * count_);
}

std::vector<Bounds> BoundsPass::read() {
  std::vector<Bounds> result(count_);
  if (count_ == 0) return result;
  std::vector<float> boxes(8 * count_);
  std::memcpy(boxes.data(), copy_.finish(), box_bytes * count_);
  for (std::size_t i = 0; i < count_; ++i) {
    const float* box = boxes.data() + 8 * i;
    result[i] = {{box[0], box[1], box[2]}, {box[4], box[5], box[6]}};
  }
  return result;
}

FitPass::FitPass() : program_(make_program({"fit.comp"})) {}

void FitPass::fit(const Buffer& frame, const Buffer& boxes, std::size_t bodies, int shadow_side,
                  int ground_side) const {
  frame.bind_storage(0);
  boxes.bind_storage(binding::first_free);
  glUseProgram(program_.get());
  glUniform1ui(0, GLuint(bodies));
  glUniform2f(1, float(shadow_side), float(ground_side));
  glDispatchCompute(1, 1, 1);
  glMemoryBarrier(GL_UNIFORM_BARRIER_BIT);
}

}  // namespace mercury::render
