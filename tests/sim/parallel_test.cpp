// SPDX-License-Identifier: Apache-2.0
#include "mercury/parallel.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

namespace mercury {
namespace {

TEST(Parallel, EachIndexIsWorkedOnOnce) {
  for (const auto loop : {+[](std::vector<std::atomic<int>>& counts) {
                            parallel_for(3, counts.size(), [&](std::size_t i) { ++counts[i]; });
                          },
                          +[](std::vector<std::atomic<int>>& counts) {
                            parallel_tasks(3, counts.size(), [&](std::size_t i) { ++counts[i]; });
                          }}) {
    std::vector<std::atomic<int>> counts(1000);
    loop(counts);
    for (std::size_t i = 0; i < counts.size(); ++i) EXPECT_EQ(counts[i], i < 3 ? 0 : 1) << i;
  }
}

TEST(Parallel, EmptyLoopsDoNothing) {
  parallel_for(5, 5, [](std::size_t) { FAIL(); });
  parallel_for(5, 2, [](std::size_t) { FAIL(); });
  parallel_tasks(5, 2, [](std::size_t) { FAIL(); });
}

TEST(Parallel, ExceptionsComeOut) {
  EXPECT_THROW(parallel_for(0, 100,
                            [](std::size_t i) {
                              if (i == 70) throw std::out_of_range("70");
                            }),
               std::out_of_range);
}

TEST(Parallel, PoolsLimitTheThreads) {
  for (const int threads : {1, 3}) {
    const ThreadPool pool(threads);
    EXPECT_EQ(pool.threads(), static_cast<std::size_t>(threads));
    std::mutex mutex;
    std::set<std::thread::id> ids;
    pool.execute([&] {
      EXPECT_EQ(parallel_threads(), static_cast<std::size_t>(threads));
      parallel_tasks(0, 1000, [&](std::size_t) {
        const std::lock_guard lock(mutex);
        ids.insert(std::this_thread::get_id());
      });
    });
    EXPECT_LE(ids.size(), static_cast<std::size_t>(threads));
  }
}

// The child has none of its parent's threads, and the locks that these held are locked forever.
TEST(Parallel, ForkedProcessesLoopWhateverTheirParentsThreadsDo) {
  parallel_for(0, 50, [](std::size_t) {});  // there are threads from now on
  std::atomic<bool> stop = false;
  std::vector<std::thread> threads;
  for (int i = 0; i < 3; ++i)
    threads.emplace_back([&] {
      while (!stop) parallel_for(0, 50, [](std::size_t) {});
    });
  for (int i = 0; i < 200; ++i) {
    const pid_t child = fork();
    if (child == 0) {
      alarm(20);
      const ThreadPool pool(2);
      if (pool.threads() != 1) _exit(2);
      std::vector<int> squares(50);
      pool.execute(
          [&] { parallel_for(0, squares.size(), [&](std::size_t k) { squares[k] = static_cast<int>(k * k); }); });
      _exit(squares.back() == 49 * 49 ? 0 : 1);
    }
    int status = -1;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    ASSERT_EQ(status, 0) << "fork " << i;
  }
  stop = true;
  for (std::thread& thread : threads) thread.join();
}

}  // namespace
}  // namespace mercury
