// SPDX-License-Identifier: Apache-2.0
#include "app/live/background.h"

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "mercury/host_memory.h"

namespace mercury {

struct Background::Parts {
  struct Entry {
    std::uint64_t id;
    std::string name;
    std::int64_t total;
    Task task;
    std::shared_ptr<WorkControl> control = std::make_shared<WorkControl>();
  };

  explicit Parts(Messages& all) : messages(all) {}

  Messages& messages;
  std::mutex mutex;
  std::condition_variable begun, ended;
  std::deque<Entry> waiting;
  std::optional<Entry> running;
  std::vector<Finish> finished;
  std::uint64_t last_id = 0;
  bool quit = false;
  std::thread thread;

  void run() {
    std::unique_lock lock(mutex);
    for (;;) {
      begun.wait(lock, [&] { return quit || !waiting.empty(); });
      if (quit) return;
      running = std::move(waiting.front());
      waiting.pop_front();
      lock.unlock();
      Finish finish = run_task(*running);
      lock.lock();
      if (finish && !running->control->canceled()) finished.push_back(std::move(finish));
      running.reset();
      ended.notify_all();
    }
  }

  Finish run_task(Entry& entry) {
    try {
      if (!entry.control->canceled()) return entry.task(*entry.control);
    } catch (const std::bad_alloc&) {
      messages.add(Severity::error, entry.name + ": " + no_memory_line());
    } catch (const std::exception& error) {
      messages.add(Severity::error, error.what());
    }
    return {};
  }
};

Background::Background(Messages& messages) : parts_(std::make_unique<Parts>(messages)) {
  parts_->thread = std::thread([parts = parts_.get()] { parts->run(); });
}

Background::~Background() {
  {
    const std::lock_guard lock(parts_->mutex);
    parts_->quit = true;
    if (parts_->running) parts_->running->control->cancel();
    parts_->begun.notify_all();
  }
  parts_->thread.join();
}

std::uint64_t Background::begin(std::string name, std::int64_t total, Task task) {
  const std::lock_guard lock(parts_->mutex);
  parts_->waiting.push_back({++parts_->last_id, std::move(name), total, std::move(task)});
  parts_->begun.notify_all();
  return parts_->last_id;
}

void Background::cancel(std::uint64_t id) {
  const std::lock_guard lock(parts_->mutex);
  if (parts_->running && parts_->running->id == id) parts_->running->control->cancel();
  std::erase_if(parts_->waiting, [&](const Parts::Entry& entry) { return entry.id == id; });
  parts_->ended.notify_all();
}

std::vector<Work> Background::work() const {
  const std::lock_guard lock(parts_->mutex);
  std::vector<Work> all;
  const auto add = [&](const Parts::Entry& entry) {
    all.push_back({entry.id, entry.name, entry.control->done(), entry.total});
  };
  if (parts_->running) add(*parts_->running);
  for (const Parts::Entry& entry : parts_->waiting) add(entry);
  return all;
}

bool Background::finish_done() {
  std::vector<Finish> finished;
  {
    const std::lock_guard lock(parts_->mutex);
    finished.swap(parts_->finished);
  }
  for (const Finish& finish : finished) finish();
  return !finished.empty();
}

void Background::wait() {
  std::unique_lock lock(parts_->mutex);
  parts_->ended.wait(lock, [&] { return !parts_->running && parts_->waiting.empty(); });
}

}  // namespace mercury
