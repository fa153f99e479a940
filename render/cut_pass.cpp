// SPDX-License-Identifier: Apache-2.0
#include "render/cut_pass.h"

#include "render/bindings.h"

namespace mercury::render {

CutPass::CutPass() : program_(make_program({"cut_planes.comp"})) {}

void CutPass::find(Bodies& bodies, const Cut& cut) const {
  if (bodies.body_count() == 0) return;
  bodies.write_rest();
  bodies.rest_positions.bind_storage(binding::first_free);
  bodies.first_masses.bind_storage(binding::first_free + 1);
  glUseProgram(program_.get());
  glUniform1i(0, cut.axis);
  glUniform1i(1, cut.below ? 1 : 0);
  glUniform1f(2, cut.percent / 100);
  glUniform1f(3, cut.shift);
  glDispatchCompute(GLuint(bodies.body_count()), 1, 1);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

}  // namespace mercury::render
