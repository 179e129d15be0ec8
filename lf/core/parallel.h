// Threads. The only place with oneTBB.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace lf {

// A fixed number of threads that loops run on. Results of everything we compute are the same for
// any number.
class ThreadPool {
 public:
  // thread_count 0: as many as the machine (or the process's CPU set) has.
  explicit ThreadPool(int thread_count = 0);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  int thread_count() const;

  // Calls body(i) once for every i in [0, count), in any order and at the same time; returns when
  // all are done. Items are taken one by one, so they should cost at least some microseconds.
  void ForEach(size_t count, const std::function<void(size_t)>& body);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace lf
