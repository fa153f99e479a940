// SPDX-License-Identifier: Apache-2.0
#include "render/fit_pass.h"

#include "render/bindings.h"

namespace mercury::render {

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
