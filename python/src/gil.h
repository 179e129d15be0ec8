// SPDX-License-Identifier: Apache-2.0
// Python's lock (GIL), released and taken such that Python can end at any time.
//
// When Python ends, it ends each thread that tries to take its lock by unwinding the thread's
// stack. Destructors of C++ do not allow that, and the process would be aborted. Therefore threads
// of this module stop for good instead of taking the lock once Python ends, and Python waits for
// those that are about to take it.
#pragma once

#include <pybind11/pybind11.h>

namespace lf::python {

// Releases the lock, and takes it again in the destructor. If Python ends meanwhile, the thread
// stops in the constructor or destructor, until the process has ended.
class GilPause {
 public:
  GilPause();
  ~GilPause();
  GilPause(const GilPause&) = delete;
  GilPause& operator=(const GilPause&) = delete;

 private:
  PyThreadState* state_;
};

// Takes the lock, or does nothing if Python ends. Any thread may have one, also one that holds the
// lock already.
class GilHold {
 public:
  GilHold();
  ~GilHold();
  GilHold(const GilHold&) = delete;
  GilHold& operator=(const GilHold&) = delete;

  bool has_lock() const { return has_lock_; }

 private:
  bool has_lock_;
  PyGILState_STATE state_ = PyGILState_UNLOCKED;
};

// While one exists, Python waits before it ends, for a few seconds at most. For work in the
// background, which does not need Python.
class EndDelay {
 public:
  EndDelay();
  ~EndDelay();
  EndDelay(const EndDelay&) = delete;
  EndDelay& operator=(const EndDelay&) = delete;

 private:
  bool is_inside_;
};

// True if Python ends and the calling thread is not the one that ends it. Work should end soon.
bool PythonEnds();

// Makes Python call this module when it ends, and when it forks.
void WatchForEndOfPython();

}  // namespace lf::python
