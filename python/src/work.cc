#include "python/src/work.h"

#include <pybind11/pybind11.h>
#include <unistd.h>

#include <chrono>
#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <thread>

#include "python/src/errors.h"

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

// Runs Python's handlers of the signals that have arrived. Returns true if one of them has raised
// an exception, which is then Python's current one.
bool HandlerRaises() {
  const py::gil_scoped_acquire acquire;
  return PyErr_CheckSignals() != 0;
}

}  // namespace

void RunWithoutGil(const std::function<void()>& work, Interrupts* interrupts) {
  std::exception_ptr failure;
  bool raised = false;
  {
    const py::gil_scoped_release release;
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
      if (interrupts == nullptr || !HandlerRaises()) continue;
      raised = true;
      interrupts->stop = true;
      interrupts->interrupted = true;
      ending.Wait();
      break;
    }
    worker.join();
  }
  if (raised) {
    interrupts->stop = false;
    interrupts->interrupted = false;
    throw py::error_already_set();
  }
  if (failure) std::rethrow_exception(failure);
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
