// What a node does: one package of a job, from the checkpoint that is there to its last frame; and,
// when all are done, what makes a film of them.
#pragma once

#include <atomic>
#include <string>

#include "lf/cluster/job.h"
#include "lf/cluster/task_state.h"
#include "lf/core/result.h"

namespace lf {

// Renders the package by lfrenderer, which is begun again when it dies; both hold the task's lock.
// Its words are added to the task's log, and its state is written wherever it changes.
//
//   node  the name of this machine, for people
//   stop  asks for the end: lfrenderer writes its state
//
// The state says how it ended: kDone; kInterrupted by `stop` or the job's cancellation; kFailed
// (any other exit code, or more crashes than the job allows). A package that is done is left alone.
// kOutput: another process has the package and does not let go of it; the state cannot be written.
Result<TaskState> RunPackage(const ClusterJob& job, size_t number, const std::string& node,
                             const std::atomic<bool>& stop);

// The error that a task's end means for whoever runs it. kBelowRequired if it is done, but
// lfrenderer ended so; none if it is done otherwise.
Result<void> OutcomeOf(const std::string& name, const TaskState& state);

// Makes sure that every frame is there, then writes contact sheet and video by lfrenderer. The
// error names all packages that are not done, has the kind of the first that failed, and is
// kInterrupted if none did. kBelowRequired as lfrenderer's.
Result<void> FinishFilm(const ClusterJob& job, const std::string& node,
                        const std::atomic<bool>& stop);

}  // namespace lf
