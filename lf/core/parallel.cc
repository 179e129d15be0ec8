// SPDX-License-Identifier: Apache-2.0
#include "lf/core/parallel.h"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <time.h>

#include <algorithm>
#include <atomic>

#ifdef __SANITIZE_THREAD__
#include <sanitizer/tsan_interface.h>
#endif

namespace lf {
namespace {

// We do not compile oneTBB, so the thread sanitizer does not see that a loop begins before its
// items and that the items end before the loop does. It sees all other accesses to shared memory.
#ifdef __SANITIZE_THREAD__
void ComesBefore(void* place) { __tsan_release(place); }
void ComesAfter(void* place) { __tsan_acquire(place); }
#else
void ComesBefore(void*) {}
void ComesAfter(void*) {}
#endif
char loop_begins;  // global, because threads must not read a loop's variables before ComesAfter()

}  // namespace

struct ThreadPool::State {
  explicit State(int thread_count)
      : limit(tbb::global_control::max_allowed_parallelism, static_cast<size_t>(thread_count)),
        arena(thread_count) {}
  // Without this limit, the arena uses no more threads than tbb thinks the machine has.
  tbb::global_control limit;
  tbb::task_arena arena;
};

ThreadPool::ThreadPool(int thread_count)
    : state_(std::make_unique<State>(thread_count > 0 ? thread_count
                                                      : tbb::info::default_concurrency())) {}
ThreadPool::~ThreadPool() = default;

int ThreadPool::thread_count() const { return state_->arena.max_concurrency(); }

void ThreadPool::ForEach(size_t count, const std::function<void(size_t)>& body) {
  // There is one task per thread, which takes the next item until none is left. tbb alone would cut
  // [0, count) into halves and begin in the middle of it.
  std::atomic<size_t> next = 0;
  const size_t task_count = std::min(count, static_cast<size_t>(thread_count()));
  ComesBefore(&loop_begins);
  state_->arena.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<size_t>(0, task_count, 1),
        [&](const tbb::blocked_range<size_t>&) {
          ComesAfter(&loop_begins);
          const auto take = [&] { return next.fetch_add(1, std::memory_order_relaxed); };
          for (size_t i = take(); i < count; i = take()) body(i);
          ComesBefore(&next);
        },
        tbb::simple_partitioner{});
  });
  ComesAfter(&next);
}

int64_t ThreadCpuTimer::Now() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return int64_t{1'000'000'000} * time.tv_sec + time.tv_nsec;
}

}  // namespace lf
