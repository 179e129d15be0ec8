// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/cluster/run_locally.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <mutex>
#include <optional>
#include <thread>

#include "lf/core/file.h"
#include "lf/core/log.h"
#include "lf/distribute/cluster/run_package.h"

namespace lf {

std::string NodeName() {
  if (const char* node = std::getenv("SLURMD_NODENAME")) return node;
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "here";
}

Result<void> RunLocally(const ClusterJob& job, const FileLock& /*lock*/,
                        const std::vector<size_t>& numbers, const std::atomic<bool>& stop,
                        const std::function<void()>& look) {
  LF_RETURN_IF_ERROR(CreateFolder(job.Folder() / "packages"));
  const std::string node = NodeName();
  std::atomic<size_t> next = 0, working = 0;
  std::mutex error_mutex;
  std::optional<Error> no_state;  // first error of RunPackage()
  const auto work = [&] {
    for (size_t i = next++; i < numbers.size() && !stop && !job.IsCancelled(); i = next++) {
      const std::string name = PackageTask(job, numbers[i]).name;
      const Result<TaskState> state = RunPackage(job, numbers[i], node, stop);
      const Result<void> outcome = state ? OutcomeOf(name, *state) : state.error();
      // An interruption needs no warning.
      if (!outcome && outcome.error().kind != ErrorKind::kInterrupted)
        LogWarning("{}{}", state ? "" : name + ": ", outcome.error().message);
      const std::lock_guard lock(error_mutex);
      if (!state && !no_state) no_state = state.error();
    }
    --working;
  };
  working = std::clamp<size_t>(job.at_once, 1, std::max<size_t>(1, numbers.size()));
  std::vector<std::thread> threads(working);
  for (std::thread& thread : threads) thread = std::thread(work);
  for (int tick = 1; working > 0; ++tick) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    if (tick % 5 == 0) look();
  }
  for (std::thread& thread : threads) thread.join();
  const std::string again = "to continue: " + ResumeCommand(job);
  if (job.IsCancelled()) return Error{ErrorKind::kInterrupted, "the job was cancelled; " + again};
  if (stop)
    return Error{ErrorKind::kInterrupted,
                 "interrupted; the state of all packages is kept; " + again};
  if (no_state) return Error{no_state->kind, fmt::format("{}; {}", no_state->message, again)};
  return FinishFilm(job, node, stop);
}

}  // namespace lf
