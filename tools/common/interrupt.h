// SPDX-License-Identifier: Apache-2.0
// Turns SIGINT, SIGTERM and SIGHUP into a flag that long work polls.
#pragma once

#include <atomic>

#include "lf/render/pipeline/render.h"

namespace lf {

// From now on the first SIGINT, SIGTERM or SIGHUP sets the returned flag; under nohup, SIGHUP is
// ignored. A SIGINT more than half a second later ends the program at once. A second SIGTERM does
// not end it, because batch systems repeat SIGTERM.
//
// If the program has not ended 1.5 seconds after the first signal, because some step of its work
// takes longer, it ends by EndInterrupted() (process_start.h). Its files must therefore be right
// after a kill, as those of every program are: a result gets its name only when it is complete.
// Reads from web servers end soon after the first signal.
const std::atomic<bool>& CatchInterrupts();

// As CatchInterrupts(), but gives the program the time that it needs to end: for a program that
// waits until its child processes have ended.
const std::atomic<bool>& CatchInterruptsOfJob();

// Does what CatchInterruptsOfJob() does, for a render: SIGINT, SIGTERM and SIGHUP make it write a
// checkpoint and end; SIGUSR1 makes it write one and continue. Must be called only once.
RenderSignals& CatchRenderSignals();

// While an object exists, a signal that CatchRenderSignals() catches ends the program within the
// time of CatchInterrupts(): for work before a render, which writes no checkpoint. There may be
// several objects, and a program that calls CatchInterrupts() may have some.
class EndsSoon {
 public:
  EndsSoon();
  ~EndsSoon();
  EndsSoon(const EndsSoon&) = delete;
  EndsSoon& operator=(const EndsSoon&) = delete;
};

}  // namespace lf
