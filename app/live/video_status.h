// SPDX-License-Identifier: Apache-2.0
// The progress of a video that is made in the background.
#pragma once

#include <cstdint>
#include <string>

namespace mercury {

struct VideoStatus {
  enum class State { running, finishing, done, canceled, failed } state = State::running;
  std::int64_t frames = 0;   // written
  std::int64_t total = 0;    // to write; 0 = unknown
  std::int64_t dropped = 0;  // because the encoder was too slow
  std::string file;
  std::string error;  // one line, if failed
  bool over() const { return state != State::running && state != State::finishing; }
};

}  // namespace mercury
