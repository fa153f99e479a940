// SPDX-License-Identifier: Apache-2.0
#include "render/passes/pass_timer.h"

namespace mercury::render {
namespace {

constexpr std::size_t pictures_under_way = 4;

}  // namespace

PassTimer::PassTimer() : ring_(pictures_under_way) {}

void PassTimer::stamp() {
  Picture& picture = ring_[current_];
  if (picture.used == picture.queries.size()) {
    GLuint name = 0;
    glCreateQueries(GL_TIMESTAMP, 1, &name);
    picture.queries.emplace_back(name);
  }
  glQueryCounter(picture.queries[picture.used++].get(), GL_TIMESTAMP);
}

void PassTimer::begin() {
  collect(ring_[current_]);
  ring_[current_].used = 0;
  ring_[current_].names.clear();
  stamp();
}

void PassTimer::mark(const char* name) {
  ring_[current_].names.push_back(name);
  stamp();
}

void PassTimer::end() {
  ring_[current_].pending = true;
  current_ = (current_ + 1) % ring_.size();
}

// Drops times that have not arrived yet; never waits.
void PassTimer::collect(Picture& picture) {
  if (!picture.pending) return;
  picture.pending = false;
  GLint ready = 0;
  glGetQueryObjectiv(picture.queries[picture.used - 1].get(), GL_QUERY_RESULT_AVAILABLE, &ready);
  if (!ready) return;
  std::vector<PassTime> times;
  GLuint64 last = 0;
  for (std::size_t i = 0; i < picture.used; ++i) {
    GLuint64 now = 0;
    glGetQueryObjectui64v(picture.queries[i].get(), GL_QUERY_RESULT, &now);
    if (i > 0) times.push_back({picture.names[i - 1], 1e-6 * double(now - last)});
    last = now;
  }
  times_ = std::move(times);
}

}  // namespace mercury::render
