// SPDX-License-Identifier: Apache-2.0
// Memory for moments, used again.
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "app/live/moment.h"

namespace mercury {

// take() may find a moment of before inside: every member is to be set. Whoever lets the last reference go, on whatever
// thread, gives the memory back.
class MomentPool {
 public:
  std::shared_ptr<Moment> take() {
    std::unique_ptr<Moment> moment;
    {
      const std::lock_guard lock(shelf_->mutex);
      if (!shelf_->free.empty()) {
        moment = std::move(shelf_->free.back());
        shelf_->free.pop_back();
      }
    }
    if (!moment) moment = std::make_unique<Moment>();
    return {moment.release(), [shelf = shelf_](Moment* done) {
              std::unique_ptr<Moment> owned(done);
              const std::lock_guard lock(shelf->mutex);
              if (shelf->free.size() < 4) shelf->free.push_back(std::move(owned));
            }};
  }

 private:
  struct Shelf {
    std::mutex mutex;
    std::vector<std::unique_ptr<Moment>> free;
  };
  std::shared_ptr<Shelf> shelf_ = std::make_shared<Shelf>();
};

}  // namespace mercury
