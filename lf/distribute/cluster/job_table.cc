// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/cluster/job_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

#include "lf/core/quantities.h"
#include "lf/core/spelling.h"

namespace lf {
namespace {

constexpr size_t kMostMessage = 72;  // longest shown message, in characters; the log has all of it

std::string EngineText(const ClusterJob& job) {
  if (job.engine == ClusterEngine::kLocal)
    return fmt::format("on this machine, {} at a time", job.at_once);
  if (job.engine != ClusterEngine::kSlurm) return fmt::format("on a farm ({})", NameOf(job.engine));
  return fmt::format("on slurm (array {}, finishing {})", fmt::join(job.slurm_array_ids, ", "),
                     job.slurm_finishing_id.empty() ? "-" : job.slurm_finishing_id);
}

std::string StateText(const TaskStatus& task) {
  const bool is_pending = task.queue == "PENDING";
  if (is_pending && task.state.start_count > 0) return "queued again";
  if (is_pending) return "queued";
  if (task.state.phase == TaskPhase::kRunning || task.queue.empty() || task.queue == "RUNNING" ||
      task.state.phase == TaskPhase::kDone)
    return NameOf(task.state.phase);
  std::string queue = task.queue;
  std::transform(queue.begin(), queue.end(), queue.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return queue;
}

std::string Shortened(const std::string& message) {
  const std::string text = Spelled(message);
  if (text.size() <= kMostMessage) return text;
  return text.substr(0, kMostMessage - 3) + "...";
}

// Returns a task's message, with Slurm's usual reasons in words.
std::string MessageOf(const TaskStatus& task) {
  if (task.state.phase == TaskPhase::kDone && task.state.exit_code == 0) return "";
  if (task.queue != "PENDING") return Shortened(task.message);
  if (task.message == "None" || task.message == "Resources" || task.message == "Priority")
    return "waiting for a node";
  if (task.message == "BeginTime") return "Slurm waits two minutes before it restarts a task";
  if (task.message == "Dependency") return "waiting for the packages";
  return Shortened(task.message);
}

std::vector<std::string> Row(const TaskStatus& task, bool is_package) {
  const bool is_running = task.state.phase == TaskPhase::kRunning;
  const auto if_package = [&](std::string text) { return is_package ? std::move(text) : ""; };
  return {
      task.name,
      StateText(task),
      task.state.node.empty() || task.queue == "PENDING" ? "-" : task.state.node,
      if_package(fmt::format("{}/{}", task.frames_done, task.frame_total)),
      if_package(fmt::format("{:.0f} %", 100 * task.DoneShare())),
      is_running && task.image_total > 0 ? fmt::format("{}/{}", task.image_done, task.image_total)
                                         : "",
      is_running && task.rate > 0 ? fmt::format("{}{}/s", ShortNumber(task.rate), task.unit) : "",
      is_running && task.seconds_left ? ShortDuration(*task.seconds_left) : "",
      task.state.start_count > 0 ? fmt::format("{}", task.state.restart_count()) : "",
      MessageOf(task)};
}

// Returns true if the job is not done, and continues only if it is resumed.
bool NeedsResume(const ClusterJob& job, const JobStatus& status) {
  const bool has_tasks = std::any_of(status.packages.begin(), status.packages.end(),
                                     [](const TaskStatus& task) { return task.IsQueued(); });
  if (has_tasks || status.finishing.IsQueued()) return false;
  if (status.phase == TaskPhase::kWaiting) return job.engine == ClusterEngine::kLocal;
  return status.phase == TaskPhase::kInterrupted || status.phase == TaskPhase::kFailed;
}

}  // namespace

std::string JobSummary(const JobStatus& status) {
  const double share = status.ray_total() > 0 ? static_cast<double>(status.rays_done()) /
                                                    static_cast<double>(status.ray_total())
                                              : 0;
  std::string text =
      fmt::format("{} of {} packages done", status.Count(TaskPhase::kDone), status.packages.size());
  for (const TaskPhase phase : {TaskPhase::kRunning, TaskPhase::kInterrupted, TaskPhase::kFailed})
    if (const size_t count = status.Count(phase))
      text += fmt::format(", {} {}", count, NameOf(phase));
  return text + fmt::format("; {} of {} frames, {:.0f} %", status.frames_done(),
                            status.frame_total(), 100 * share);
}

std::string JobTable(const ClusterJob& job, const JobStatus& status) {
  std::string text = fmt::format("{}: {}{} {}: {}", job.output_folder.string(),
                                 status.is_cancelled ? "cancelled, " : "", NameOf(status.phase),
                                 EngineText(job), JobSummary(status));
  if (const auto left_s = status.seconds_left())
    text += fmt::format("; about {} left", ShortDuration(*left_s));
  text += "\n";
  if (!status.queue_error.empty())
    text += fmt::format("the queue cannot be queried ({}): this table is made from files only\n",
                        Spelled(status.queue_error));
  std::vector<std::vector<std::string>> rows = {{"package", "state", "on", "frames", "rays",
                                                 "LF images", "rate", "left", "restarts",
                                                 "message"}};
  for (const TaskStatus& task : status.packages) rows.push_back(Row(task, true));
  rows.push_back(Row(status.finishing, false));
  std::vector<size_t> widths(rows.front().size());
  for (const auto& row : rows)
    for (size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  for (const auto& row : rows) {
    std::string line;
    for (size_t i = 0; i < row.size(); ++i) {
      // Texts are left-aligned, numbers right-aligned; empty columns are left out.
      const bool is_used = widths[i] > rows.front()[i].size() ||
                           std::any_of(rows.begin() + 1, rows.end(),
                                       [i](const auto& other) { return !other[i].empty(); });
      if (!is_used) continue;
      const bool is_number = i >= 3 && i <= 8;
      line += is_number ? fmt::format("{:>{}}  ", row[i], widths[i])
                        : fmt::format("{:<{}}  ", row[i], widths[i]);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  if (NeedsResume(job, status)) text += "to continue: " + ResumeCommand(job) + "\n";
  return text;
}

}  // namespace lf
