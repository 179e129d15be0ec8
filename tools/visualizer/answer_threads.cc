// SPDX-License-Identifier: Apache-2.0
#include "tools/visualizer/answer_threads.h"

#include <system_error>
#include <utility>

namespace lf {

bool AnswerThreads::Run(std::function<void()> task) {
  const std::lock_guard lock(mutex_);
  if (is_stopped_) return false;
  if (idle_count_ <= tasks_.size() && threads_.size() < most_count_) {
    try {
      threads_.emplace_back([this] { Work(); });
    } catch (const std::system_error&) {
      if (threads_.empty()) return false;  // otherwise a running thread will take the task
    }
  }
  tasks_.push_back(std::move(task));
  changed_.notify_one();
  return true;
}

void AnswerThreads::Work() {
  std::unique_lock lock(mutex_);
  while (true) {
    ++idle_count_;
    changed_.wait(lock, [&] { return is_stopped_ || !tasks_.empty(); });
    --idle_count_;
    if (tasks_.empty()) return;
    std::function<void()> task = std::move(tasks_.front());
    tasks_.pop_front();
    lock.unlock();
    task();
    task = nullptr;
    lock.lock();
  }
}

void AnswerThreads::Stop() {
  {
    const std::lock_guard lock(mutex_);
    is_stopped_ = true;
    changed_.notify_all();
  }
  for (std::thread& thread : threads_) thread.join();
  threads_.clear();
}

}  // namespace lf
