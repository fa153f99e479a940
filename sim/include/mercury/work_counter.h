// SPDX-License-Identifier: Apache-2.0
// What several threads have done of a work that a caller watches.
#pragma once

#include <atomic>
#include <cstddef>
#include <mutex>

#include "mercury/work_watch.h"

namespace mercury {

// Counts items, and shows the watch how many are done. Without a watch it does nothing.
class WorkCounter {
 public:
  // The watch and `what` outlive the counter.
  WorkCounter(const WorkWatch& watch, const char* what, std::size_t total)
      : watch_(watch), what_(what), total_(total) {}

  // One more item is done. Several threads may call it at the same time. Exceptions of the watch pass through.
  void add_one() {
    if (!watch_) return;
    const std::size_t now = ++done_;
    // Another thread that calls the watch right now is as good.
    if (const std::unique_lock lock(watching_, std::try_to_lock); lock) watch_(what_, now, total_);
  }

 private:
  const WorkWatch& watch_;
  const char* what_;
  std::size_t total_;
  std::atomic<std::size_t> done_ = 0;
  std::mutex watching_;
};

}  // namespace mercury
