// SPDX-License-Identifier: Apache-2.0
#include "lf/core/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <thread>
#include <vector>

namespace lf {
namespace {

TEST(ThreadPool, RunsEveryItemOnce) {
  for (const int threads : {1, 2, 5}) {
    ThreadPool pool(threads);
    EXPECT_EQ(pool.thread_count(), threads);
    std::vector<std::atomic<int>> calls(1000);
    pool.ForEach(calls.size(), [&](size_t i) { ++calls[i]; });
    for (const auto& count : calls) EXPECT_EQ(count, 1);
  }
}

TEST(ThreadPool, ItemsAreBegunInOrder) {
  for (const int threads : {1, 3}) {
    ThreadPool pool(threads);
    std::mutex mutex;
    std::vector<size_t> begun;
    pool.ForEach(1000, [&](size_t i) {
      const std::lock_guard lock(mutex);
      begun.push_back(i);
    });
    ASSERT_EQ(begun.size(), 1000u);
    // Threads may overtake each other between taking an item and noting it. One thread cannot.
    for (size_t i = 0; threads == 1 && i < begun.size(); ++i) EXPECT_EQ(begun[i], i);
    if (threads > 1) {
      EXPECT_LT(begun.front(), 3u);
    }
  }
}

TEST(ThreadCpuTimer, SleepIsNoWork) {
  const ThreadCpuTimer timer;
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_LT(timer.Nanoseconds(), 50'000'000);
  const int64_t before = timer.Nanoseconds();
  volatile uint64_t sum = 0;
  for (uint64_t i = 0; i < 1'000'000; ++i) sum = sum + i;
  EXPECT_GT(timer.Nanoseconds(), before);
}

TEST(ThreadPool, LoopsCanBeNestedAndEmpty) {
  ThreadPool pool(2);
  std::atomic<int> sum = 0;
  pool.ForEach(0, [&](size_t) { ++sum; });
  pool.ForEach(4, [&](size_t) { pool.ForEach(3, [&](size_t) { ++sum; }); });
  EXPECT_EQ(sum, 12);
}

}  // namespace
}  // namespace lf
