// SPDX-License-Identifier: Apache-2.0
// Loops on several CPU threads.
#pragma once

#include <cstddef>
#include <memory>

namespace mercury {
namespace detail {

using IndexedCall = void (*)(const void* work, std::size_t index);
using Call = void (*)(const void* work);
void run_parallel(std::size_t first, std::size_t end, bool each_alone, IndexedCall call, const void* work);

}  // namespace detail

// work(i) for first <= i < end, in any order, on the threads of the ThreadPool around it, or on all cores. One of the
// exceptions that it throws is passed on; then calls that have not begun may be left out.
//
// A process that was forked after the first loop has no such threads. Its loops run on the thread that calls them.
template <class Work>
void parallel_for(std::size_t first, std::size_t end, const Work& work) {
  detail::run_parallel(
      first, end, false, [](const void* of, std::size_t i) { (*static_cast<const Work*>(of))(i); }, &work);
}

// The same for few calls that take long, or take very different times: each is handed out alone.
template <class Work>
void parallel_tasks(std::size_t first, std::size_t end, const Work& work) {
  detail::run_parallel(
      first, end, true, [](const void* of, std::size_t i) { (*static_cast<const Work*>(of))(i); }, &work);
}

// How many threads a loop has here.
std::size_t parallel_threads();

// Limits the threads of the loops within execute().
class ThreadPool {
 public:
  explicit ThreadPool(int threads);  // 0 = one per core
  ~ThreadPool();

  std::size_t threads() const;

  template <class Work>
  void execute(const Work& work) const {
    run([](const void* of) { (*static_cast<const Work*>(of))(); }, &work);
  }

 private:
  void run(detail::Call call, const void* work) const;

  struct Arena;
  std::unique_ptr<Arena> arena_;  // none in a process without threads
};

}  // namespace mercury
