// SPDX-License-Identifier: Apache-2.0
// GPU times of the parts of a picture. They are read some frames later, so that nothing waits.
#pragma once

#include <epoxy/gl.h>

#include <array>
#include <string>
#include <vector>

#include "render/context/gl_objects.h"
#include "render/renderer.h"

namespace mercury::render {

struct ReleaseQuery {
  void operator()(GLuint name) const { glDeleteQueries(1, &name); }
};
using Query = GlName<ReleaseQuery>;

class PassTimer {
 public:
  PassTimer();
  // begin() a picture, mark() the end of each part, end() the picture.
  void begin();
  void mark(const char* name);
  void end();
  // Of the last frame whose times are known; empty until there is one.
  const std::vector<PassTime>& times() const { return times_; }

 private:
  struct Picture {
    std::vector<Query> queries;  // one more than names
    std::vector<const char*> names;
    std::size_t used = 0;
    bool pending = false;
  };
  void stamp();
  void collect(Picture& picture);

  std::vector<Picture> ring_;
  std::size_t current_ = 0;
  std::vector<PassTime> times_;
};

// Keeps the CPU at most two frames ahead of the GPU, as StreamBuffer requires.
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
