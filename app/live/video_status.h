// SPDX-License-Identifier: Apache-2.0
// How far a film in the background is.
#pragma once

#include <cstdint>
#include <string>

namespace mercury {

struct VideoStatus {
  enum class State { running, finishing, done, cancelled, failed } state = State::running;
  std::int64_t frames = 0;   // written
  std::int64_t total = 0;    // to be written; 0 = open end
  std::int64_t dropped = 0;  // that came too fast for the encoder
  std::string file;
  std::string error;  // one line, if failed
  bool over() const { return state != State::running && state != State::finishing; }
};

}  // namespace mercury
