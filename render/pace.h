// SPDX-License-Identifier: Apache-2.0
// Keeps the CPU at most two pictures ahead of the GPU, as StreamBuffer requires.
#pragma once

#include <epoxy/gl.h>

#include <array>

namespace mercury::render {

class Pace {
 public:
  ~Pace() {
    for (const GLsync fence : fences_)
      if (fence) glDeleteSync(fence);
  }
  void begin() {
    constexpr GLuint64 patience = 20'000'000'000;  // [ns]
    GLsync& fence = fences_[next_];
    if (fence) {
      glClientWaitSync(fence, GL_SYNC_FLUSH_COMMANDS_BIT, patience);
      glDeleteSync(fence);
      fence = nullptr;
    }
  }
  void end() {
    fences_[next_] = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    next_ = (next_ + 1) % fences_.size();
  }

 private:
  std::array<GLsync, 2> fences_{};
  std::size_t next_ = 0;
};

}  // namespace mercury::render
