// SPDX-License-Identifier: Apache-2.0
// Background tasks of the window: reading files, making robots.
//
// A task has two parts. The first runs on the background thread, one task after the other, and must not touch the
// scene. It returns the second, `Finish`, which runs on the window's thread in finish_done() and may change the scene.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/live/messages.h"

namespace mercury {

// The progress of a task, as the window shows it.
struct Work {
  std::uint64_t id = 0;
  std::string name;  // "making 24 robots"
  std::int64_t done = 0, total = 0;
};

// Connects a running task with the window: the task reports progress, the window cancels. Thread-safe.
class WorkControl {
 public:
  bool canceled() const { return canceled_; }
  void progress(std::int64_t done) { done_ = done; }
  void cancel() { canceled_ = true; }
  std::int64_t done() const { return done_; }

 private:
  std::atomic<bool> canceled_ = false;
  std::atomic<std::int64_t> done_ = 0;
};

// Exceptions thrown by a task are reported to `messages`.
class Background {
 public:
  using Finish = std::function<void()>;
  using Task = std::function<Finish(WorkControl&)>;

  explicit Background(Messages& messages);
  ~Background();  // cancels all tasks and waits for the running one

  std::uint64_t begin(std::string name, std::int64_t total, Task task);  // returns its id
  void cancel(std::uint64_t id);
  std::vector<Work> work() const;  // the running task and those that wait
  bool finish_done();              // calls the Finish functions of ended tasks; returns whether there was one
  void wait();                     // until all tasks have ended; does not call Finish functions

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace mercury
