// SPDX-License-Identifier: Apache-2.0
#include "app/base/bounded_queue.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

namespace mercury::test {
namespace {

TEST(BoundedQueue, KeepsTheOrderAndNeverHoldsMoreThanItsCapacity) {
  BoundedQueue<int> queue(3);
  std::atomic<int> pushed = 0;
  std::thread writer([&] {
    for (int i = 0; i < 10000; ++i) {
      queue.push(i);
      ++pushed;
    }
    queue.close();
  });
  for (int i = 0; i < 10000; ++i) {
    EXPECT_LE(pushed.load(), i + 4);  // 3 in the queue, and one popped since
    EXPECT_EQ(queue.pop(), i);
  }
  EXPECT_EQ(queue.pop(), std::nullopt);
  writer.join();
}

TEST(BoundedQueue, ClosedQueueCanStillBeEmptied) {
  BoundedQueue<int> queue(2);
  EXPECT_TRUE(queue.push(1));
  queue.close();
  EXPECT_FALSE(queue.push(2));
  EXPECT_EQ(queue.pop(), 1);
  EXPECT_EQ(queue.pop(), std::nullopt);
}

TEST(BoundedQueue, AbandonWakesAWaitingWriter) {
  BoundedQueue<int> queue(1);
  queue.push(1);
  bool taken = true;
  std::thread writer([&] { taken = queue.push(2); });
  queue.abandon();
  writer.join();
  EXPECT_FALSE(taken);
  EXPECT_EQ(queue.pop(), std::nullopt);
}

}  // namespace
}  // namespace mercury::test
