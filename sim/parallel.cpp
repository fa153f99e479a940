// SPDX-License-Identifier: Apache-2.0
#include "mercury/parallel.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/partitioner.h>
#include <oneapi/tbb/task_arena.h>
#include <pthread.h>

#include <algorithm>
#include <atomic>
#include <optional>

namespace mercury {
namespace {

// A child has TBB's locks as they were when its parent forked, held by threads that it does not have.
std::atomic<bool> has_used_threads = false, has_lost_threads = false;
[[maybe_unused]] const int watched = pthread_atfork(nullptr, nullptr, [] {
  if (has_used_threads) has_lost_threads = true;
});

bool may_use_threads() {
  if (has_lost_threads) return false;
  has_used_threads = true;
  return true;
}

}  // namespace

namespace detail {

void run_parallel(std::size_t first, std::size_t end, bool each_alone, IndexedCall call, const void* work) {
  const auto one = [&](std::size_t i) { call(work, i); };
  if (!may_use_threads()) {
    for (std::size_t i = first; i < end; ++i) one(i);
  } else if (each_alone) {
    oneapi::tbb::parallel_for(
        oneapi::tbb::blocked_range<std::size_t>(first, std::max(first, end), 1),
        [&](const auto& range) {
          for (std::size_t i = range.begin(); i < range.end(); ++i) one(i);
        },
        oneapi::tbb::simple_partitioner());
  } else {
    oneapi::tbb::parallel_for(first, end, one);
  }
}

}  // namespace detail

std::size_t parallel_threads() {
  return may_use_threads() ? static_cast<std::size_t>(oneapi::tbb::this_task_arena::max_concurrency()) : 1;
}

struct ThreadPool::Arena {
  explicit Arena(int threads) : arena(threads > 0 ? threads : oneapi::tbb::task_arena::automatic) {
    // Without this, TBB refuses more threads than cores, with a warning on stderr.
    if (threads > oneapi::tbb::info::default_concurrency())
      allowance.emplace(oneapi::tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  }

  std::optional<oneapi::tbb::global_control> allowance;
  oneapi::tbb::task_arena arena;
};

ThreadPool::ThreadPool(int threads) {
  if (may_use_threads()) arena_ = std::make_unique<Arena>(threads);
}

ThreadPool::~ThreadPool() {
  // To end it would take locks.
  if (has_lost_threads) (void)arena_.release();
}

std::size_t ThreadPool::threads() const {
  return arena_ && may_use_threads() ? static_cast<std::size_t>(arena_->arena.max_concurrency()) : 1;
}

void ThreadPool::run(detail::Call call, const void* work) const {
  if (arena_ && may_use_threads())
    arena_->arena.execute([&] { call(work); });
  else
    call(work);
}

}  // namespace mercury
