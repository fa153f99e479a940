// SPDX-License-Identifier: Apache-2.0
// GPU times of the parts of a picture. They are read some pictures later, so that nothing waits.
#pragma once

#include <string>
#include <vector>

#include "render/gl_objects.h"
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
  // Of the last picture whose times are known; empty until there is one.
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

}  // namespace mercury::render
