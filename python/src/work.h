// Runs long work without Python's lock (GIL), so that other threads of Python go on, and so that
// Ctrl-C is answered.
#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <optional>
#include <utility>

#include "lf/core/parallel.h"

namespace lf::python {

// Requests that end work soon. Work that can be interrupted reads them (WorkOptions::interrupted,
// WorkOptions::stop).
struct Interrupts {
  std::atomic<bool> interrupted = false;
  std::atomic<bool> stop = false;
};

// Calls work() on another thread and waits for its end. The calling thread holds the GIL before and
// after, and runs Python's signal handlers meanwhile: if one of them raises, as that of Ctrl-C does
// in Python's main thread, sets both requests, waits for the end of the work, clears them, and
// throws what was raised. Otherwise throws what work() threw.
//   interrupts  null: the work cannot be interrupted, and is waited for
void RunWithoutGil(const std::function<void()>& work, Interrupts* interrupts = nullptr);

// Does the same as RunWithoutGil(), and returns what work() returns.
template <class Work>
auto CallWithoutGil(const Work& work, Interrupts* interrupts = nullptr) {
  std::optional<decltype(work())> result;
  RunWithoutGil([&] { result.emplace(work()); }, interrupts);
  return *std::move(result);
}

// Returns threads of this process. All calls with the same thread_count return the same ones, which
// live until the process ends.
//   thread_count  0: one for each processor
// Throws a Failure (kUsage) in a process that was forked from one that already had such threads,
// because a fork does not copy threads.
ThreadPool& PoolOf(int thread_count);

}  // namespace lf::python
