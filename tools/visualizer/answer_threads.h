// SPDX-License-Identifier: Apache-2.0
// Threads that answer requests of the page, so that a slow answer does not delay others.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace lf {

class AnswerThreads {
 public:
  // Run() starts up to `most_count` threads, when they are needed. If all are busy, tasks wait in a
  // queue.
  explicit AnswerThreads(size_t most_count) : most_count_(most_count) {}
  ~AnswerThreads() { Stop(); }
  AnswerThreads(const AnswerThreads&) = delete;
  AnswerThreads& operator=(const AnswerThreads&) = delete;

  // Queues a task, which must not throw. Returns false, and does not run the task, after Stop(), or
  // if no thread runs yet and the machine has none left.
  bool Run(std::function<void()> task);
  // Returns when all tasks have ended, including those in the queue.
  void Stop();

 private:
  void Work();

  const size_t most_count_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> tasks_;
  std::vector<std::thread> threads_;
  size_t idle_count_ = 0;
  bool is_stopped_ = false;
};

}  // namespace lf
