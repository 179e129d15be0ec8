// SPDX-License-Identifier: Apache-2.0
#include "python/src/work.h"

#include <pybind11/pybind11.h>
#include <unistd.h>

#include <chrono>
#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

#include "python/src/errors.h"
#include "python/src/gil.h"

namespace lf::python {
namespace {

namespace py = pybind11;

// Time between two looks at Python's signals.
constexpr std::chrono::milliseconds kPatience{50};

// Tells when work on another thread has ended.
class Ending {
 public:
  void Tell() {
    const std::lock_guard lock(mutex_);
    has_ended_ = true;
    news_.notify_all();
  }
  bool WaitFor(std::chrono::milliseconds time) {
    std::unique_lock lock(mutex_);
    return news_.wait_for(lock, time, [&] { return has_ended_; });
  }
  void Wait() {
    std::unique_lock lock(mutex_);
    news_.wait(lock, [&] { return has_ended_; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable news_;
  bool has_ended_ = false;
};

// Tells how far the work has come.
void TellNews(WorkSignals* signals) {
  if (signals == nullptr || !signals->tell) return;
  for (const WorkProgress& news : signals->TakeNews())
    signals->tell(news.done, news.total, news.phase);
}

// Runs Python's handlers of the signals that have arrived, and tells the progress. Returns what
// they raise.
std::exception_ptr Look(WorkSignals* signals) {
  const GilHold hold;
  if (!hold.has_lock()) return nullptr;
  try {
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    TellNews(signals);
  } catch (...) {
    return std::current_exception();
  }
  return nullptr;
}

}  // namespace

void RunWithoutGil(const std::function<void()>& work, WorkSignals* signals) {
  std::exception_ptr failure, raised;
  {
    const GilPause pause;
    Ending ending;
    std::thread worker([&] {
      try {
        work();
      } catch (...) {
        failure = std::current_exception();
      }
      ending.Tell();
    });
    while (!ending.WaitFor(kPatience)) {
      if (signals == nullptr) continue;
      raised = Look(signals);
      if (!raised && !PythonEnds()) continue;
      signals->stop = true;
      signals->interrupted = true;
      ending.Wait();
      break;
    }
    worker.join();
  }
  if (raised) {
    signals->stop = false;
    signals->interrupted = false;
    std::rethrow_exception(raised);
  }
  if (failure) std::rethrow_exception(failure);
  TellNews(signals);
}

void RunOrAbandon(std::function<void()> work) {
  struct Shared {
    std::function<void()> work;
    Ending ending;
    std::exception_ptr failure = nullptr;
  };
  const auto shared = std::make_shared<Shared>();
  shared->work = std::move(work);
  std::exception_ptr raised;
  {
    const GilPause pause;
    std::thread([shared] {
      const EndDelay delay;
      try {
        shared->work();
      } catch (...) {
        shared->failure = std::current_exception();
      }
      shared->ending.Tell();
    }).detach();
    while (!raised && !PythonEnds() && !shared->ending.WaitFor(kPatience)) raised = Look(nullptr);
  }
  if (raised) std::rethrow_exception(raised);
  if (shared->failure) std::rethrow_exception(shared->failure);
}

ThreadPool& PoolOf(int thread_count) {
  // Never freed: threads of Python may still use the pools while the process ends.
  static auto* const pools = new std::map<int, std::unique_ptr<ThreadPool>>;
  static std::mutex* const mutex = new std::mutex;
  static const pid_t process = getpid();
  if (process != getpid())
    throw Failure(UsageError(
        "lfrendertools had threads when this process was forked, and they do not exist here: start "
        "processes by multiprocessing.get_context(\"spawn\"), or import lfrendertools only in "
        "them"));
  const std::lock_guard lock(*mutex);
  std::unique_ptr<ThreadPool>& pool = (*pools)[thread_count];
  if (!pool) pool = std::make_unique<ThreadPool>(thread_count);
  return *pool;
}

}  // namespace lf::python
