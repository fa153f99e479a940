// SPDX-License-Identifier: Apache-2.0
// A portion of an evaluator's robots: consecutive ones that are made, loaded and stepped together.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "mercury/evaluator.h"

namespace mercury {

// A robot of the source, or the reason why there is none.
struct Candidate {
  std::shared_ptr<const Robot> robot;
  std::string failure;    // empty = the robot can be used
  std::size_t bytes = 0;  // host memory that it takes until it is yielded, about
};

struct Portion {
  std::size_t first = 0;  // index of the first candidate in the source
  std::vector<Candidate> candidates;
  bool is_last = false;  // the source ends after it

  std::size_t bytes() const;
  std::vector<std::shared_ptr<const Robot>> robots() const;  // those that can be used
};

// How far a portion may grow.
struct PortionLimits {
  std::size_t bytes = 0;
  // Asked before each robot but the first, one thread at a time: whether that many robots are enough.
  std::function<bool(std::size_t count)> enough;
  // Whether to give up. The portion is then incomplete.
  std::function<bool()> canceled;
};

// Makes robots of the source from `first` on until the source or a limit ends the portion; at least one, if there is
// one. `is_serial`: in order in this thread, otherwise on all cores. `largest` = bytes of the largest robot
// so far; it is updated.
Portion make_portion(const RobotSource& source, std::size_t first, std::size_t end, const PortionLimits& limits,
                     bool is_serial, std::atomic<std::size_t>& largest);

}  // namespace mercury
