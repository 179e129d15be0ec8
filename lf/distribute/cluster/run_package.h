// The tasks of a job: renders a package from its checkpoint to its last frame; when all packages
// are done, makes a film of them.
#pragma once

#include <atomic>
#include <string>

#include "lf/core/result.h"
#include "lf/distribute/cluster/job.h"
#include "lf/distribute/cluster/task_state.h"

namespace lf {

// Renders the package with lfrenderer, which is restarted if it crashes; both processes hold the
// task's lock. The output is appended to the task's log; every change is written to its state.
//
//   node  the name of this machine, for people
//   stop  asks for the end: lfrenderer writes a checkpoint
//
// The phase of the result is kDone; kInterrupted by `stop` or the job's cancellation; or kFailed
// (any other exit code, or more crashes than the job allows). A package that is done, with all its
// frames, is not rendered again.
// kOutput: another process holds the package for two minutes; the state cannot be written. kInput:
// the state is damaged.
Result<TaskState> RunPackage(const ClusterJob& job, size_t number, const std::string& node,
                             const std::atomic<bool>& stop);

// Converts the end of a task to an error for the caller. kBelowRequired if it is done but
// lfrenderer ended with that error; no error if it is done otherwise.
Result<void> OutcomeOf(const std::string& name, const TaskState& state);

// Checks that every frame exists, then writes contact sheet and video with lfrenderer. The error
// names all packages that are not done, and has the kind of the first failed one, or kInterrupted
// if none failed. kBelowRequired if lfrenderer ends with it.
Result<void> FinishFilm(const ClusterJob& job, const std::string& node,
                        const std::atomic<bool>& stop);

}  // namespace lf
