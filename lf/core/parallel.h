// SPDX-License-Identifier: Apache-2.0
// Runs loops on threads. All use of oneTBB is in parallel.cc.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>

namespace lf {

// A fixed number of threads that loops run on. No result of this project depends on that number.
class ThreadPool {
 public:
  // thread_count 0: as many threads as the machine (or the process's CPU set) has processors.
  explicit ThreadPool(int thread_count = 0);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  int thread_count() const;

  // Calls body(i) once for every i in [0, count), in parallel, and returns when all calls have
  // ended. The calls begin in the order of i, each on the next free thread. Each call should
  // therefore take at least some microseconds, and the longest calls should come first.
  void ForEach(size_t count, const std::function<void(size_t)>& body);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// Measures the CPU time that the calling thread has used since construction.
class ThreadCpuTimer {
 public:
  ThreadCpuTimer() : begin_ns_(Now()) {}
  int64_t Nanoseconds() const { return Now() - begin_ns_; }

 private:
  static int64_t Now();
  int64_t begin_ns_;
};

}  // namespace lf
