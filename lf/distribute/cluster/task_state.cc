// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/cluster/task_state.h"

#include <fmt/format.h>

#include <chrono>
#include <fstream>

#include "lf/core/file.h"
#include "lf/core/spelling.h"
#include "lf/core/value_named.h"
#include "lf/render/state/record_fields.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr size_t kTaskLimit_bytes = size_t{1} << 20;
constexpr const char* kTaskFormat = "lftask 1";

// Reads the entry `name`, [done, total], of the object "counts" of a progress line. Changes nothing
// if there is none.
void GetCount(const Json& line, const char* name, uint64_t* done, uint64_t* total) {
  const auto counts = line.find("counts");
  if (counts == line.end() || !counts->is_object()) return;
  const auto count = counts->find(name);
  if (count == counts->end() || !count->is_array() || count->size() != 2) return;
  if (!(*count)[0].is_number_unsigned() || !(*count)[1].is_number_unsigned()) return;
  *done = (*count)[0].get<uint64_t>();
  *total = (*count)[1].get<uint64_t>();
}

void TakeProgress(std::string_view line, TaskProgress* progress) {
  const Json json = Json::parse(line, nullptr, false);
  if (json.is_discarded() || !json.is_object()) return;
  std::string fault;
  TaskProgress now;
  RecordFields fields(json, &fault);
  fields.Get("unit", &now.unit);
  fields.Get("done", &now.done);
  fields.Get("total", &now.total);
  fields.Get("rate", &now.rate);
  fields.Get("seconds_left", &now.seconds_left);
  if (!fault.empty() || now.total == 0 || now.done > now.total) return;
  GetCount(json, "LF image", &now.image_done, &now.image_total);
  now.message = std::move(progress->message);
  *progress = std::move(now);
}

// Returns the last kMostBytes of a log, without a first line that is incomplete.
std::string LastOf(const fs::path& log) {
  constexpr std::streamoff kMostBytes = 16384;
  std::ifstream file(log, std::ios::binary);
  if (!file) return {};
  file.seekg(0, std::ios::end);
  const std::streamoff size = file.tellg();
  const std::streamoff begin = std::max<std::streamoff>(0, size - kMostBytes);
  file.seekg(begin);
  std::string text(static_cast<size_t>(size - begin), '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<size_t>(std::max<std::streamsize>(0, file.gcount())));
  if (begin > 0) text.erase(0, text.find('\n') + 1);
  return text;
}

}  // namespace

const char* NameOf(TaskPhase phase) {
  constexpr const char* kNames[] = {"waiting", "running", "interrupted", "done", "failed"};
  return kNames[static_cast<int>(phase)];
}

std::string ToJson(const TaskState& state) {
  const Json json = {{"format", kTaskFormat},        {"phase", NameOf(state.phase)},
                     {"node", state.node},           {"process", state.process},
                     {"starts", state.start_count},  {"crashes", state.crash_count},
                     {"exit_code", state.exit_code}, {"message", Spelled(state.message)},
                     {"begin_s", state.begin_s},     {"end_s", state.end_s}};
  return RecordText(json);
}

Result<TaskState> ParseTaskState(std::string_view text, const std::string& name) {
  std::string fault, phase;
  TaskState state;
  const Json json = ParseRecord(text, kTaskFormat, &fault);
  if (fault.empty()) {
    RecordFields fields(json, &fault);
    fields.Get("phase", &phase);
    fields.Get("node", &state.node);
    fields.Get("process", &state.process);
    fields.Get("starts", &state.start_count);
    fields.Get("crashes", &state.crash_count);
    fields.Get("exit_code", &state.exit_code);
    fields.Get("message", &state.message);
    fields.Get("begin_s", &state.begin_s);
    fields.Get("end_s", &state.end_s);
    const auto known =
        ValueNamed(phase, {TaskPhase::kWaiting, TaskPhase::kRunning, TaskPhase::kInterrupted,
                           TaskPhase::kDone, TaskPhase::kFailed});
    if (known) state.phase = *known;
    if (fault.empty() && !known)
      fault = fmt::format(
          "\"phase\": expected waiting, running, interrupted, done or failed, found \"{}\"", phase);
  }
  if (!fault.empty())
    return InputError(
        fmt::format("{}: is damaged: {}; remove the file (rendered frames are kept)", name, fault));
  return state;
}

Result<TaskState> ReadTaskState(const fs::path& path) {
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return TaskState{};
  LF_ASSIGN_OR_RETURN(const std::string text, ReadFile(path, kTaskLimit_bytes));
  return ParseTaskState(text, path.string());
}

Result<void> WriteTaskState(const TaskState& state, const fs::path& path) {
  return WriteFileAtomically(path, ToJson(state));
}

TaskProgress ParseProgress(std::string_view log) {
  TaskProgress progress;
  while (!log.empty()) {
    const std::string_view line = log.substr(0, log.find('\n'));
    log.remove_prefix(std::min(log.size(), line.size() + 1));
    if (line.starts_with(kLogStart)) {
      // Unit, done and total are kept, because a start continues the work of the previous one.
      progress.rate = progress.seconds_left = 0;
      progress.image_done = progress.image_total = 0;
      progress.message.clear();
    } else if (line.starts_with('{')) {
      TakeProgress(line, &progress);
    } else if (!line.empty()) {
      progress.message = line;
    }
  }
  return progress;
}

TaskProgress ReadProgress(const fs::path& log) {
  TaskProgress progress = ParseProgress(LastOf(log));
  std::error_code error;
  const auto written = fs::last_write_time(log, error);
  if (!error)
    progress.quiet_s =
        std::chrono::duration<double>(fs::file_time_type::clock::now() - written).count();
  return progress;
}

std::vector<std::string> LinesOfLastStart(const fs::path& log) {
  const std::string text = LastOf(log);
  std::vector<std::string> lines;
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    std::string line = text.substr(begin, end - begin);
    begin = end + 1;
    if (line.starts_with(kLogStart))
      lines.clear();
    else if (!line.empty() && !line.starts_with('{'))
      lines.push_back(std::move(line));
  }
  return lines;
}

}  // namespace lf
