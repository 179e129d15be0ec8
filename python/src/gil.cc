// SPDX-License-Identifier: Apache-2.0
#include "python/src/gil.h"

#include <unistd.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace lf::python {
namespace {

namespace py = pybind11;

// Longest time that Python waits in the end for threads of this module.
constexpr std::chrono::seconds kPatience{10};

// The way back into Python. It is closed when Python ends; only the thread that ends it may pass
// from then on.
struct Door {
  std::mutex mutex;
  std::condition_variable left;
  int inside_count = 0;  // threads that Python waits for before it ends
  bool is_closed = false;
  std::thread::id keeper;  // the thread that ends Python

  // Must be called with the mutex.
  bool Stops() const { return is_closed && std::this_thread::get_id() != keeper; }
  bool Enter() {
    const std::lock_guard lock(mutex);
    if (Stops()) return false;
    ++inside_count;
    return true;
  }
  void Leave() {
    const std::lock_guard lock(mutex);
    --inside_count;
    left.notify_all();
  }
};

// Never freed: threads may use it while the process ends. A forked process has none of the threads
// that are inside, and therefore gets a door of its own.
Door* door = new Door;

[[noreturn]] void StopThisThread() {
  for (;;) pause();
}

// Is called when Python ends, after it has waited for the threads that it waits for by itself.
void Close() {
  {
    const std::lock_guard lock(door->mutex);
    door->is_closed = true;
    door->keeper = std::this_thread::get_id();
  }
  const py::gil_scoped_release release;
  std::unique_lock lock(door->mutex);
  door->left.wait_for(lock, kPatience, [] { return door->inside_count == 0; });
}

}  // namespace

GilPause::GilPause() : state_(PyEval_SaveThread()) {
  if (!door->Enter()) StopThisThread();
}

GilPause::~GilPause() {
  if (PythonEnds()) {
    door->Leave();
    StopThisThread();
  }
  PyEval_RestoreThread(state_);
  door->Leave();
}

GilHold::GilHold() : has_lock_(Py_IsInitialized() != 0 && door->Enter()) {
  if (has_lock_) state_ = PyGILState_Ensure();
}

GilHold::~GilHold() {
  if (!has_lock_) return;
  PyGILState_Release(state_);
  door->Leave();
}

EndDelay::EndDelay() : is_inside_(door->Enter()) {}

EndDelay::~EndDelay() {
  if (is_inside_) door->Leave();
}

bool PythonEnds() {
  const std::lock_guard lock(door->mutex);
  return door->Stops();
}

void WatchForEndOfPython() {
  py::module_::import("atexit").attr("register")(py::cpp_function(&Close));
  py::module_::import("os").attr("register_at_fork")(py::arg("after_in_child") =
                                                         py::cpp_function([] { door = new Door; }));
}

}  // namespace lf::python
