// SPDX-License-Identifier: Apache-2.0
// Runs long work without Python's lock (GIL), so that other threads of Python go on, and so that
// Ctrl-C is answered.
#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "lf/core/parallel.h"

namespace lf::python {

// How far work has come. Each phase counts anew.
struct WorkProgress {
  size_t done = 0;
  size_t total = 0;
  int phase = 0;  // 0, 1, ...
};

// Signals between the thread of Python that waits and the work on another thread.
class WorkSignals {
 public:
  // Requests that end work soon. Work that can be interrupted reads them
  // (WorkSettings::interrupted, WorkSettings::stop).
  std::atomic<bool> interrupted = false;
  std::atomic<bool> stop = false;

  // If set, called with the GIL after the progress has changed, by the thread that waits. It may
  // throw what a function of Python has raised, which ends the work as Ctrl-C does.
  std::function<void(size_t done, size_t total, int phase)> tell = {};

  // Called by the work.
  void SetProgress(const WorkProgress& now) {
    const std::lock_guard lock(mutex_);
    if (news_.empty() || news_.back().phase != now.phase) news_.push_back(now);
    news_.back() = now;
  }
  // Returns the progress since the last call: of each phase the last one, so that even a phase that
  // was over between two calls is told.
  std::vector<WorkProgress> TakeNews() {
    const std::lock_guard lock(mutex_);
    return std::exchange(news_, {});
  }

 private:
  std::mutex mutex_;
  std::vector<WorkProgress> news_;
};

// Calls work() on another thread and waits for its end. The calling thread holds the GIL before and
// after. Meanwhile it runs Python's signal handlers and signals->tell(): if one of them raises, as
// the handler of Ctrl-C does in Python's main thread, sets both requests, waits for the end of the
// work, clears them, and throws what was raised. Otherwise throws what work() threw. If Python ends
// meanwhile, ends the work in the same way, and does not return.
//   signals  null: the work cannot be interrupted, and is waited for
void RunWithoutGil(const std::function<void()>& work, WorkSignals* signals = nullptr);

// Does the same as RunWithoutGil(), and returns what work() returns.
template <class Work>
auto CallWithoutGil(const Work& work, WorkSignals* signals = nullptr) {
  std::optional<decltype(work())> result;
  RunWithoutGil([&] { result.emplace(work()); }, signals);
  return *std::move(result);
}

// Calls work() on another thread and waits for its end, as RunWithoutGil(), for work that has no
// place where it can be interrupted. If a signal handler of Python raises meanwhile, throws that at
// once; the work goes on in the background, and what it returns or throws is lost.
//   work  owns everything that it uses, because the caller may be gone when it ends
void RunOrAbandon(std::function<void()> work);

// Does the same as RunOrAbandon(), and returns what work() returns.
template <class Work>
auto CallOrAbandon(Work work) {
  const auto result = std::make_shared<std::optional<decltype(work())>>();
  RunOrAbandon([result, work = std::move(work)] { result->emplace(work()); });
  return **std::move(result);
}

// Returns threads of this process. All calls with the same thread_count return the same ones, which
// live until the process ends.
//   thread_count  0: one for each processor
// Throws a Failure (kUsage) in a process that was forked from one that already had such threads,
// because a fork does not copy threads.
ThreadPool& PoolOf(int thread_count);

}  // namespace lf::python
