// SPDX-License-Identifier: Apache-2.0
// Memory of snapshots, used again: a snapshot of a large scene is tens of megabytes, too much to allocate per picture.
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "app/live/snapshot.h"

namespace mercury {

// Whoever drops the last reference to a snapshot, on whatever thread, gives its memory back to the pool. The pool may
// be destroyed before its snapshots.
class SnapshotPool {
 public:
  // A snapshot that may still hold old values: the caller sets every member.
  std::shared_ptr<Snapshot> take() {
    std::unique_ptr<Snapshot> snapshot;
    {
      const std::lock_guard lock(free_->mutex);
      if (!free_->snapshots.empty()) {
        snapshot = std::move(free_->snapshots.back());
        free_->snapshots.pop_back();
      }
    }
    if (!snapshot) snapshot = std::make_unique<Snapshot>();
    return {snapshot.release(), [free = free_](Snapshot* done) {
              std::unique_ptr<Snapshot> owned(done);
              owned->positions.release_device();
              owned->second.reset();
              owned->ghosts.reset();
              const std::lock_guard lock(free->mutex);
              if (free->snapshots.size() < most_free) free->snapshots.push_back(std::move(owned));
            }};
  }

 private:
  static constexpr std::size_t most_free = 4;
  struct Free {
    std::mutex mutex;
    std::vector<std::unique_ptr<Snapshot>> snapshots;
  };
  std::shared_ptr<Free> free_ = std::make_shared<Free>();
};

}  // namespace mercury
