// SPDX-License-Identifier: Apache-2.0
// Work beside the window: reading files, growing robots.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/live/messages.h"

namespace mercury {

// One piece of work as it is told to the user.
struct Work {
  std::uint64_t id = 0;
  std::string name;  // "growing 24 robots"
  std::int64_t done = 0, total = 0;
};

// Told to the work while it goes on.
class WorkControl {
 public:
  bool cancelled() const { return cancelled_; }
  void progress(std::int64_t done) { done_ = done; }
  void cancel() { cancelled_ = true; }
  std::int64_t done() const { return done_; }

 private:
  std::atomic<bool> cancelled_ = false;
  std::atomic<std::int64_t> done_ = 0;
};

// Does one piece after the other on a thread of its own. Its end, `finish`, runs on the thread that calls
// finish_done(). What a piece throws is told.
class Background {
 public:
  using Finish = std::function<void()>;
  using Piece = std::function<Finish(WorkControl&)>;

  explicit Background(Messages& messages);
  ~Background();  // cancels all, and waits for the piece that goes on

  std::uint64_t begin(std::string name, std::int64_t total, Piece piece);
  void cancel(std::uint64_t id);
  std::vector<Work> work() const;  // what goes on and what waits
  bool finish_done();              // whether anything was
  void wait();                     // until all is done, not finished

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace mercury
