// SPDX-License-Identifier: Apache-2.0
// Runs the tasks of a job: renders a package, from its checkpoint if there is one; when all
// packages are done, makes the video and the contact sheet.
#pragma once

#include <atomic>
#include <functional>
#include <string>

#include "lf/core/result.h"
#include "lf/distribute/cluster/job.h"
#include "lf/distribute/cluster/task_state.h"

namespace lf {

// Renders a package with lfrenderer, and restarts lfrenderer if it crashes, or if the frames to
// finish early (finish_frames.h) change. This process and lfrenderer both hold the task's lock. The
// output of lfrenderer is appended to the task's log. Every change is written to the task's state
// file.
//
//   number  index of the package in job.packages
//   node    the name of this machine, for the state, the log and messages
//   stop    true: lfrenderer writes a checkpoint and ends
//   look    called about once a second while lfrenderer runs; may be empty
//
// The phase of the result is kDone; kInterrupted, because of `stop` or because the job was
// cancelled; or kFailed, because lfrenderer could not be started, ended with an exit code other
// than 0, kInterrupted and kBelowRequired, or crashed more often than the job allows. A package
// that is done and whose frames all exist is not rendered again.
// kOutput: another process holds the task's lock for two minutes, or until `stop` is true; the
// state cannot be written. kInput: the state or the list of frames to finish is damaged.
Result<TaskState> RunPackage(const ClusterJob& job, size_t number, const std::string& node,
                             const std::atomic<bool>& stop, const std::function<void()>& look = {});

// Converts the state of a task that has ended to a result. No error if the task is done and
// lfrenderer succeeded; kBelowRequired if the task is done, but lfrenderer ended with
// kBelowRequired. If the task failed, an error with the kind of lfrenderer's exit code (kOutput if
// that is 0); otherwise kInterrupted.
//   name  for messages
Result<void> OutcomeOf(const std::string& name, const TaskState& state);

// Runs the finishing task: checks that every frame exists, then runs lfrenderer to write the
// contact sheet, the video and DIR/cluster/report.json. If packages are not done, the error names
// them all; its kind is the kind with which the first failed package ended, or kInterrupted if no
// package failed. kBelowRequired if lfrenderer ends with kBelowRequired.
Result<void> FinishFilm(const ClusterJob& job, const std::string& node,
                        const std::atomic<bool>& stop);

}  // namespace lf
