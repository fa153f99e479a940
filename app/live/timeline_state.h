// SPDX-License-Identifier: Apache-2.0
// What a picture says about the timeline of its robots (timeline.h).
#pragma once

#include <cstddef>

namespace mercury {

// Times are simulated [s].
struct TimelineState {
  double begin = 0, head = 0;  // the moments that can be shown
  bool viewing = false;        // shows an earlier moment, or a recording
  bool recording = false;      // of a file
  bool seeking = false;        // is on its way to `target`
  double target = 0;
  bool looping = false;
  double loop_begin = 0, loop_end = 0;
  std::size_t bytes = 0, budget = 0, keyframes = 0;  // of memory: used, at most
};

}  // namespace mercury
