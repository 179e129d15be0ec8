// Threads that make answers, so that a slow one holds nobody else up.
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
  // Threads start with the first task. At most `most_count`; tasks that find all busy queue up.
  explicit AnswerThreads(size_t most_count) : most_count_(most_count) {}
  ~AnswerThreads() { Stop(); }
  AnswerThreads(const AnswerThreads&) = delete;
  AnswerThreads& operator=(const AnswerThreads&) = delete;

  // The task must not throw. False after Stop(), or if the machine has no thread left; the task
  // is not run then.
  bool Run(std::function<void()> task);
  // Returns when all tasks have ended, those in the queue included.
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
