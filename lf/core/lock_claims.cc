// SPDX-License-Identifier: Apache-2.0
#include "lf/core/lock_claims.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fstream>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "lf/core/file.h"
#include "lf/core/hash.h"
#include "lf/core/log.h"
#include "lf/core/process_identity.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

// Another claim is looked at kLooksAtClaims times, with pauses, before it counts as settled. The
// process whose name comes later gives way, and tries again kClaimAttempts times.
constexpr int kLooksAtClaims = 25, kClaimAttempts = 4;
constexpr auto kBetweenLooks = std::chrono::milliseconds(4);

double Seconds(const timespec& time) {
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// Returns when the file was refreshed last; nullopt if it is gone. The file is opened, because NFS
// asks the server for its times only then.
std::optional<double> RefreshTime(const fs::path& file) {
  struct stat status {};
  const int fd = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
  const bool is_known = (fd < 0 ? ::lstat(file.c_str(), &status) : ::fstat(fd, &status)) == 0;
  if (fd >= 0) ::close(fd);
  if (!is_known) return std::nullopt;
  return Seconds(status.st_mtim);
}

// Creates and writes a file. Returns 0, or an errno, in which case no file is left.
int CreateClaim(const fs::path& file, const std::string& text) {
  const int fd = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (fd < 0) return errno;
  ssize_t written = 0;
  do written = ::write(fd, text.data(), text.size());
  while (written < 0 && errno == EINTR);
  int reason = written == static_cast<ssize_t>(text.size()) ? 0 : written < 0 ? errno : ENOSPC;
  if (reason == 0 && ::fsync(fd) != 0) reason = errno;
  if (::close(fd) != 0 && reason == 0) reason = errno;
  if (reason != 0) ::unlink(file.c_str());
  return reason;
}

// Refreshes the claims of this process until they are released.
class Refresher {
 public:
  // Returns the refresher of this process. It is never destroyed, because its thread runs until the
  // process ends. A forked process gets one of its own: it has no thread yet, and its copies of the
  // mutex and of the condition may be in use for ever.
  static Refresher& Get() {
    static std::atomic<Refresher*> instance = nullptr;
    Refresher* known = instance;
    while (known == nullptr || known->process_ != ::getpid()) {
      auto made = std::make_unique<Refresher>();
      if (instance.compare_exchange_strong(known, made.get())) known = made.release();
    }
    return *known;
  }
  // Returns false if no thread can be started.
  bool Add(const fs::path& file, double every_s) {
    const std::lock_guard guard(mutex_);
    try {
      if (!has_thread_) std::thread([this] { Run(); }).detach();
    } catch (const std::system_error&) {
      return false;
    }
    has_thread_ = true;
    files_[file] = every_s;
    changed_.notify_one();
    return true;
  }
  // Removes the file and forgets it. A refresh never sees the file missing in between.
  void Remove(const fs::path& file) {
    const std::lock_guard guard(mutex_);
    files_.erase(file);
    ::unlink(file.c_str());
  }

 private:
  void Run() {
    std::unique_lock guard(mutex_);
    while (true) {
      double pause_s = 3600;
      for (const auto& [file, every_s] : files_) pause_s = std::min(pause_s, every_s);
      changed_.wait_for(guard, std::chrono::duration<double>(pause_s));
      for (const auto& [file, every_s] : files_)
        if (::utimensat(AT_FDCWD, file.c_str(), nullptr, 0) != 0 && errno == ENOENT) End(file);
    }
  }
  [[noreturn]] static void End(const fs::path& file) {
    LogMessage(LogLevel::kError,
               fmt::format("{}: was removed, by somebody or by a program that took over because "
                           "this one stood still for long. This program ends, because another one "
                           "may work in this folder; what it has saved can be resumed",
                           file.string()));
    std::_Exit(static_cast<int>(ErrorKind::kOutput));
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<fs::path, double> files_;  // and how often each is refreshed, in seconds
  bool has_thread_ = false;
  const pid_t process_ = ::getpid();
};

// A claim as it was found in the folder.
struct FoundClaim {
  std::string name;
  std::vector<ProcessIdentity> processes;
  double refreshed_s = 0;
};

// Returns the claims in the folder, except for the one of the name `but`.
std::vector<FoundClaim> ClaimsIn(const fs::path& folder, const std::string& but) {
  std::vector<FoundClaim> claims;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    FoundClaim claim;
    claim.name = it->path().filename().string();
    if (claim.name == but || claim.name.starts_with('.')) continue;  // .nfs...: removed files
    const auto refreshed_s = RefreshTime(it->path());
    if (!refreshed_s) continue;
    claim.refreshed_s = *refreshed_s;
    std::ifstream file(it->path());
    for (std::string line; std::getline(file, line);)
      if (auto identity = ReadIdentity(line)) claim.processes.push_back(*std::move(identity));
    claims.push_back(std::move(claim));
  }
  return claims;
}

ProcessLife LifeOfClaim(const FoundClaim& claim) {
  bool is_unknown = claim.processes.empty();
  for (const ProcessIdentity& process : claim.processes) {
    const ProcessLife life = LifeOf(process);
    if (life == ProcessLife::kLives) return life;
    is_unknown = is_unknown || life == ProcessLife::kUnknown;
  }
  return is_unknown ? ProcessLife::kUnknown : ProcessLife::kEnded;
}

Error InTheWay(const fs::path& path, const FoundClaim& claim, double now_s,
               const ClaimTimes& times) {
  const fs::path file = LockClaim::FolderOf(path) / claim.name;
  const std::string who = claim.processes.empty()
                              ? ""
                              : fmt::format(" (process {} on {})", claim.processes.front().process,
                                            claim.processes.front().host);
  const std::string remedy =
      LifeOfClaim(claim) == ProcessLife::kLives
          ? "wait for it to end"
          : fmt::format(
                "wait for it to end; if its machine is dead, call this again once its "
                "claim {} is {:.0f} s old, or remove that file",
                file.string(), times.stale_s);
  return OutputError(fmt::format(
      "{}: is locked, because another program{}, last seen {:.0f} s ago, works in this folder: {}",
      path.string(), who, std::max(0.0, now_s - claim.refreshed_s), remedy));
}

// Judges which claims in a folder live.
class ClaimJudge {
 public:
  ClaimJudge(fs::path folder, const ClaimTimes& times)
      : folder_(std::move(folder)), times_(times) {}

  // Returns the living claims, except for `own`. If none lives for sure, watches those of other
  // machines that are old.
  std::vector<FoundClaim> Living(const std::string& own) {
    const std::vector<FoundClaim> claims = ClaimsIn(folder_, own);
    std::vector<FoundClaim> living, old;
    for (const FoundClaim& claim : claims)
      if (!IsKnownDead(claim)) (IsOld(claim) ? old : living).push_back(claim);
    if (!living.empty()) return living;
    for (const FoundClaim& claim : old)
      if (IsRefreshed(claim)) living.push_back(claim);
    return living;
  }

  // Removes the claims that were found dead.
  void RemoveDead() const {
    for (const auto& [name, refreshed_s] : dead_) ::unlink((folder_ / name).c_str());
  }

  // Sets the present time by the clock of the disk, up to which ages of files are counted.
  void SetNow(double now_s) { now_s_ = now_s; }
  double now_s() const { return now_s_; }

 private:
  // Returns true if the processes of the claim have ended, or if it was found dead before and has
  // not been refreshed since.
  bool IsKnownDead(const FoundClaim& claim) {
    const auto known = dead_.find(claim.name);
    if (known != dead_.end() && known->second == claim.refreshed_s) return true;
    if (LifeOfClaim(claim) != ProcessLife::kEnded) return false;
    dead_[claim.name] = claim.refreshed_s;
    return true;
  }

  bool IsOld(const FoundClaim& claim) const {
    return LifeOfClaim(claim) == ProcessLife::kUnknown &&
           now_s_ - claim.refreshed_s >= times_.stale_s;
  }

  // Watches a claim until it is refreshed (true), or for `watch_s`. It is watched once.
  bool IsRefreshed(const FoundClaim& claim) {
    if (refreshed_.contains(claim.name)) return true;
    const fs::path file = folder_ / claim.name;
    LogInfo(
        "{}: was not refreshed for {:.0f} s: is watched for {:.0f} s, in case its program still "
        "works",
        file.string(), now_s_ - claim.refreshed_s, times_.watch_s);
    const auto begin = std::chrono::steady_clock::now();
    const std::chrono::duration<double> watch(times_.watch_s);
    while (std::chrono::steady_clock::now() - begin < watch) {
      std::this_thread::sleep_for(watch / 20);
      const auto refreshed_s = RefreshTime(file);
      if (!refreshed_s) return false;
      if (*refreshed_s == claim.refreshed_s) continue;
      refreshed_.insert(claim.name);
      return true;
    }
    dead_[claim.name] = claim.refreshed_s;
    return false;
  }

  fs::path folder_;
  ClaimTimes times_;
  double now_s_ = 0;
  std::map<std::string, double> dead_;  // and when each was refreshed last
  std::set<std::string> refreshed_;     // seen while they were watched
};

double LocalNow() {
  timespec now{};
  ::clock_gettime(CLOCK_REALTIME, &now);
  return Seconds(now);
}

// Returns a name that no other claim has or had.
std::string NewName(const ProcessIdentity& self) {
  static std::atomic<int> count = 0;
  timespec now{};
  ::clock_gettime(CLOCK_REALTIME, &now);
  return fmt::format("{:016x}-{}-{}", HashBytes(TextOf(self), static_cast<uint64_t>(now.tv_nsec)),
                     self.process, ++count);
}

Error CannotClaim(const fs::path& file, int reason) {
  return OutputError(
      fmt::format("{}: cannot be created: {}", file.string(), std::strerror(reason)));
}

}  // namespace

fs::path LockClaim::FolderOf(const fs::path& path) { return fs::path(path) += ".claims"; }

Result<std::unique_ptr<LockClaim>> LockClaim::Take(const fs::path& path, const ClaimTimes& times) {
  const fs::path folder = LockClaim::FolderOf(path);
  const ProcessIdentity self = IdentityOf(::getpid());
  ClaimJudge judge(folder, times);
  std::optional<FoundClaim> in_the_way;
  for (int attempt = 1; attempt <= kClaimAttempts; ++attempt) {
    // The pauses of two processes differ, so that they do not give way to each other for ever.
    if (attempt > 1)
      std::this_thread::sleep_for(kBetweenLooks * (1 + (self.process + attempt) % 5));
    const std::string name = NewName(self);
    const fs::path file = folder / name;
    int reason = ENOENT;
    // Another process may remove the empty folder between the two steps.
    for (int i = 0; i < 100 && reason == ENOENT; ++i) {
      if (::mkdir(folder.c_str(), 0777) != 0 && errno != EEXIST) return CannotClaim(folder, errno);
      reason = CreateClaim(file, TextOf(self) + "\n");
    }
    if (reason != 0) {
      ::rmdir(folder.c_str());
      return CannotClaim(file, reason);
    }
    std::unique_ptr<LockClaim> claim(new LockClaim(file, self.process));
    if (!Refresher::Get().Add(file, times.refresh_s))
      return OutputError(
          fmt::format("{}: cannot be refreshed, because no thread can be started", file.string()));
    judge.SetNow(RefreshTime(file).value_or(LocalNow()));
    for (int look = 1; look <= kLooksAtClaims; ++look) {
      const std::vector<FoundClaim> living = judge.Living(name);
      if (living.empty()) {
        judge.RemoveDead();
        return claim;
      }
      in_the_way = living.front();
      if (std::any_of(living.begin(), living.end(),
                      [&](const FoundClaim& other) { return other.name < name; }))
        break;
      std::this_thread::sleep_for(kBetweenLooks);
    }
  }
  return InTheWay(path, *in_the_way, judge.now_s(), times);
}

Result<void> LockClaim::CheckNone(const fs::path& path, const ClaimTimes& times) {
  const fs::path folder = LockClaim::FolderOf(path);
  if (::access(folder.c_str(), F_OK) != 0) return {};
  ClaimJudge judge(folder, times);
  // The lock file itself was written a moment ago.
  judge.SetNow(RefreshTime(path).value_or(LocalNow()));
  if (const auto living = judge.Living(""); !living.empty())
    return InTheWay(path, living.front(), judge.now_s(), times);
  judge.RemoveDead();
  ::rmdir(folder.c_str());
  return {};
}

bool LockClaim::IsAny(const fs::path& path, const ClaimTimes& times) {
  const std::vector<FoundClaim> claims = ClaimsIn(LockClaim::FolderOf(path), "");
  return std::any_of(claims.begin(), claims.end(), [&](const FoundClaim& claim) {
    const ProcessLife life = LifeOfClaim(claim);
    return life == ProcessLife::kLives ||
           (life == ProcessLife::kUnknown && LocalNow() - claim.refreshed_s < times.stale_s);
  });
}

LockClaim::~LockClaim() {
  if (owner_ != ::getpid()) return;  // a copy in a forked process
  Refresher::Get().Remove(file_);
  ::rmdir(file_.parent_path().c_str());  // fails, as intended, if it has other claims
}

Result<void> LockClaim::ShareWith(pid_t process) {
  const int fd = ::open(file_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  const std::string text = TextOf(IdentityOf(process)) + "\n";
  const bool is_written =
      fd >= 0 && ::write(fd, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  const int reason = errno;
  if (fd >= 0) ::close(fd);
  if (is_written) return {};
  return OutputError(
      fmt::format("{}: cannot be written: {}", file_.string(), std::strerror(reason)));
}

}  // namespace lf
