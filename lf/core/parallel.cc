#include "lf/core/parallel.h"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace lf {

struct ThreadPool::State {
  explicit State(int thread_count)
      : limit(tbb::global_control::max_allowed_parallelism, static_cast<size_t>(thread_count)),
        arena(thread_count) {}
  // The arena alone cannot use more threads than tbb thinks the machine has.
  tbb::global_control limit;
  tbb::task_arena arena;
};

ThreadPool::ThreadPool(int thread_count)
    : state_(std::make_unique<State>(thread_count > 0 ? thread_count
                                                      : tbb::info::default_concurrency())) {}
ThreadPool::~ThreadPool() = default;

int ThreadPool::thread_count() const { return state_->arena.max_concurrency(); }

void ThreadPool::ForEach(size_t count, const std::function<void(size_t)>& body) {
  state_->arena.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<size_t>(0, count, 1),
        [&](const tbb::blocked_range<size_t>& range) {
          for (size_t i = range.begin(); i != range.end(); ++i) body(i);
        },
        tbb::simple_partitioner{});
  });
}

}  // namespace lf
