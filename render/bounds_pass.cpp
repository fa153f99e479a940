// SPDX-License-Identifier: Apache-2.0
#include "render/bounds_pass.h"

#include <cstring>

#include "render/bindings.h"

namespace mercury::render {
namespace {

constexpr std::size_t box_bytes = 32;

}  // namespace

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

}  // namespace mercury::render
