#include "lf/core/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
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

TEST(ThreadPool, LoopsCanBeNestedAndEmpty) {
  ThreadPool pool(2);
  std::atomic<int> sum = 0;
  pool.ForEach(0, [&](size_t) { ++sum; });
  pool.ForEach(4, [&](size_t) { pool.ForEach(3, [&](size_t) { ++sum; }); });
  EXPECT_EQ(sum, 12);
}

}  // namespace
}  // namespace lf
