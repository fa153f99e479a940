#include "render/bounds_pass.h"

#include "render/bindings.h"

namespace mercury::render {

BoundsPass::BoundsPass() : program_(make_program({"body_bounds.comp"})) {}

std::vector<Bounds> BoundsPass::measure(const Bodies& bodies) {
  const std::size_t count = bodies.body_count();
  std::vector<Bounds> result(count);
  if (count == 0) return result;
  boxes_.reserve(32 * count);
  boxes_.bind_storage(binding::first_free);
  bodies.first_masses.bind_storage(binding::first_free + 1);
  glUseProgram(program_.get());
  glDispatchCompute(GLuint(count), 1, 1);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  std::vector<float> boxes(8 * count);
  glGetNamedBufferSubData(boxes_.get(), 0, GLsizeiptr(32 * count), boxes.data());
  for (std::size_t i = 0; i < count; ++i) {
    const float* box = boxes.data() + 8 * i;
    result[i] = {{box[0], box[1], box[2]}, {box[4], box[5], box[6]}};
  }
  return result;
}

}  // namespace mercury::render
