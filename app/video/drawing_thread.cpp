// SPDX-License-Identifier: Apache-2.0
#include "app/video/drawing_thread.h"

#include <unistd.h>

#include <atomic>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "mercury/error.h"

namespace mercury {

struct DrawingThread::Parts {
  struct Request {
    Task task;
    std::promise<void> done;
  };

  render::ContextKind kind;
  std::mutex mutex;
  std::condition_variable changed;
  std::deque<Request> requests;
  bool ending = false;
  std::thread thread;
  std::atomic<pid_t> process = -1;  // in which the thread was started

  bool forked() const { return process != -1 && process != getpid(); }

  void work() {
    std::optional<Canvas> canvas;
    std::exception_ptr failure;  // to make the context; it is not tried again
    for (;;) {
      std::optional<Request> request = next();
      if (!request) return;
      try {
        if (!canvas && !failure) make(canvas, failure);
        if (failure) std::rethrow_exception(failure);
        request->task(*canvas);
        request->task = nullptr;  // what it holds may need the context
        request->done.set_value();
      } catch (...) {
        request->task = nullptr;
        request->done.set_exception(std::current_exception());
      }
    }
  }

  void make(std::optional<Canvas>& canvas, std::exception_ptr& failure) const {
    try {
      // Of several GPUs, the one that CUDA counts first.
      canvas =
          Canvas{.offscreen = make_offscreen_renderer(kind, {.width = 64, .height = 64}, render::Quality::automatic, 0),
                 .owner = nullptr};
    } catch (const render::ContextError&) {
      failure = std::current_exception();
    }
  }

  // Nothing = the end.
  std::optional<Request> next() {
    std::unique_lock lock(mutex);
    changed.wait(lock, [this] { return ending || !requests.empty(); });
    if (requests.empty()) return std::nullopt;
    std::optional<Request> request(std::move(requests.front()));
    requests.pop_front();
    return request;
  }
};

DrawingThread::DrawingThread(render::ContextKind kind) : parts_(std::make_unique<Parts>()) { parts_->kind = kind; }

DrawingThread::~DrawingThread() {
  if (parts_->forked()) {
    (void)parts_.release();  // its mutex and thread are those of another process
    return;
  }
  end();
}

void DrawingThread::end() {
  if (parts_->forked()) return;
  {
    const std::lock_guard lock(parts_->mutex);
    parts_->ending = true;
  }
  parts_->changed.notify_all();
  if (parts_->thread.joinable()) parts_->thread.join();
}

void DrawingThread::require_no_fork() const {
  if (parts_->forked())
    throw DeviceError(
        "this process was forked from one that had drawn, and OpenGL does not work after that; start processes before "
        "the first picture, or with the method \"spawn\"");
}

std::future<void> DrawingThread::post(Task task) {
  require_no_fork();
  Parts& parts = *parts_;
  const std::lock_guard lock(parts.mutex);
  if (parts.ending) throw DeviceError("nothing is drawn any more; the program ends");
  if (!parts.thread.joinable()) {
    parts.process = getpid();
    parts.thread = std::thread([&parts] { parts.work(); });
  }
  parts.requests.push_back({std::move(task), {}});
  std::future<void> done = parts.requests.back().done.get_future();
  parts.changed.notify_one();
  return done;
}

}  // namespace mercury
