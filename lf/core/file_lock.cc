// SPDX-License-Identifier: Apache-2.0
#include "lf/core/file_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <fstream>
#include <string>
#include <utility>

#include "lf/core/file.h"
#include "lf/core/lock_claims.h"
#include "lf/core/log.h"
#include "lf/core/process_identity.h"

namespace lf {
namespace {

// Returns true if `path` still names the file that is open as `fd`. (The previous owner of the lock
// may have removed the file after it was opened here.)
bool IsStill(int fd, const std::filesystem::path& path) {
  struct stat open_file {
  }, named_file{};
  return ::fstat(fd, &open_file) == 0 && ::stat(path.c_str(), &named_file) == 0 &&
         open_file.st_ino == named_file.st_ino && open_file.st_dev == named_file.st_dev;
}

// Calls flock(), again if a signal interrupted it.
int Flock(int fd, int operation) {
  int result = 0;
  do result = ::flock(fd, operation);
  while (result != 0 && errno == EINTR);
  return result;
}

// Returns true if flock() failed with the errno because the disk has no locks.
bool MeansNoLocks(int reason) {
  return reason == ENOSYS || reason == ENOLCK || reason == EOPNOTSUPP;
}

void WarnOnceOfNoLocks(const std::filesystem::path& path, int reason) {
  static std::atomic<bool> is_told = false;
  if (is_told.exchange(true)) return;
  LogWarning(
      "{}: this disk has no locks ({}): files in {}.claims stand for them, which other programs "
      "respect as long as they are refreshed",
      path.string(), std::strerror(reason), path.string());
}

// Returns an error if the text of the lock file names a process that may hold the kernel's lock,
// which a process on a disk without locks cannot see.
Result<void> CheckNotLockedElsewhere(const std::filesystem::path& path) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    const auto owner = ReadIdentity(line);
    const ProcessLife life = owner ? LifeOf(*owner) : ProcessLife::kUnknown;
    if (life == ProcessLife::kEnded) continue;
    const std::string who =
        owner ? fmt::format(" (process {} on {})", owner->process, owner->host) : "";
    if (life == ProcessLife::kLives)
      return OutputError(fmt::format(
          "{}: is locked, because another program{} works in this folder: wait for it to end",
          path.string(), who));
    return OutputError(fmt::format(
        "{}: names another program{} that has locks on this disk, while this machine has none and "
        "cannot see whether it still works in this folder: wait for it to end; if it was killed, "
        "remove this file",
        path.string(), who));
  }
  return {};
}

// Writes the whole text or nothing, because the text is too short to be written in parts. Returns
// true if it was written.
bool Write(int fd, const std::string& text) {
  ssize_t written = 0;
  do written = ::pwrite(fd, text.data(), text.size(), 0);
  while (written < 0 && errno == EINTR);
  return written >= 0;
}

// Returns the number of the process that locked the file last, or "" if the file contains none.
std::string OwnerNumber(int fd) {
  char text[32] = {};
  if (::pread(fd, text, sizeof(text) - 1, 0) <= 0) return "";
  return {text, std::strspn(text, "0123456789")};
}

// Locking is attempted kAttempts times, with pauses, because IsHeld() in another process locks the
// file for a moment. While the file contains no process number, locking is attempted up to
// kAttemptsWithoutNumber times, because the owner may have locked the file a moment ago and be
// about to write its number.
constexpr timespec kPause = {.tv_sec = 0, .tv_nsec = 2'000'000};
constexpr int kAttempts = 3, kAttemptsWithoutNumber = 500;

// Locks the open file. Returns false if it cannot be locked, with the reason in errno.
bool LockOpenFile(int fd) {
  for (int attempt = 1;; ++attempt) {
    if (Flock(fd, LOCK_EX | LOCK_NB) == 0) return true;
    if (errno != EWOULDBLOCK) return false;
    if (attempt >= (OwnerNumber(fd).empty() ? kAttemptsWithoutNumber : kAttempts)) break;
    ::nanosleep(&kPause, nullptr);
  }
  errno = EWOULDBLOCK;
  return false;
}

// Opens the file, and creates it if it is missing. Returns -1, with the reason in errno, if that
// fails.
int OpenLockFile(const std::filesystem::path& path) {
  return ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
}

Error CannotBeCreated(const std::filesystem::path& path) {
  return OutputError(fmt::format("{}: cannot be created: {}", path.string(), std::strerror(errno)));
}

}  // namespace

FileLock::FileLock(std::filesystem::path path, int fd) : path_(std::move(path)), fd_(fd) {}
FileLock::FileLock(FileLock&& other) noexcept
    : path_(std::move(other.path_)),
      fd_(std::exchange(other.fd_, -1)),
      claim_(std::move(other.claim_)),
      is_removed_in_the_end_(other.is_removed_in_the_end_) {}
FileLock& FileLock::operator=(FileLock&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(fd_, other.fd_);
  std::swap(claim_, other.claim_);
  std::swap(is_removed_in_the_end_, other.is_removed_in_the_end_);
  return *this;
}
FileLock::~FileLock() {
  if (is_removed_in_the_end_) Remove();
  Release();
}

void FileLock::Remove() {
  if (fd_ < 0 && !claim_) return;
  claim_.reset();
  ::unlink(path_.c_str());
  if (fd_ >= 0) ::close(std::exchange(fd_, -1));
}

void FileLock::Release() {
  claim_.reset();
  if (fd_ < 0) return;
  [[maybe_unused]] const int ignored = ::ftruncate(fd_, 0);
  ::close(std::exchange(fd_, -1));
}

bool FileLock::IsHeld(const std::filesystem::path& path) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
  if (fd < 0) return false;
  const bool has_failed = Flock(fd, LOCK_SH | LOCK_NB) != 0;
  const int reason = errno;
  ::close(fd);
  if (has_failed && reason == EWOULDBLOCK) return true;
  if (has_failed && MeansNoLocks(reason) && !CheckNotLockedElsewhere(path)) return true;
  return LockClaim::IsAny(path);
}

bool FileLock::IsPart(const std::filesystem::path& path, const std::filesystem::path& file) {
  return file == path || file == LockClaim::FolderOf(path);
}

Result<void> FileLock::ShareWith(pid_t child) {
  if (claim_) return claim_->ShareWith(child);
  const std::string text = TextOf(IdentityOf(child)) + "\n";
  const off_t end = ::lseek(fd_, 0, SEEK_END);
  if (end < 0 || ::pwrite(fd_, text.data(), text.size(), end) < 0)
    return OutputError(
        fmt::format("{}: cannot be written: {}", path_.string(), std::strerror(errno)));
  return {};
}

Result<std::optional<FileLock>> FileLock::ClaimOpenFile(FileLock lock) {
  const int fd = std::exchange(lock.fd_, -1);  // the text of the file is another's
  Result<std::unique_ptr<LockClaim>> claim = LockClaim::Take(lock.path_);
  const bool is_still = IsStill(fd, lock.path_);
  ::close(fd);
  if (!is_still) return std::optional<FileLock>();
  if (!claim) return claim.error();
  LF_RETURN_IF_ERROR(CheckNotLockedElsewhere(lock.path_));
  lock.claim_ = *std::move(claim);
  return std::optional<FileLock>(std::move(lock));
}

Result<std::optional<FileLock>> FileLock::TakeOpenFile(const std::filesystem::path& path, int fd) {
  FileLock lock(path, fd);
  if (!LockOpenFile(fd)) {
    const int reason = errno;
    if (MeansNoLocks(reason)) {
      WarnOnceOfNoLocks(path, reason);
      return ClaimOpenFile(std::move(lock));
    }
    const std::string number = OwnerNumber(fd);
    ::close(std::exchange(lock.fd_, -1));  // the text of the file stays, because it is another's
    if (reason != EWOULDBLOCK)
      return OutputError(
          fmt::format("{}: cannot be locked: {}", path.string(), std::strerror(reason)));
    return OutputError(fmt::format(
        "{}: is locked, because another program{} works in this folder: wait for it to end",
        path.string(), number.empty() ? "" : fmt::format(" (process {})", number)));
  }
  if (!IsStill(fd, path)) return std::optional<FileLock>();
  // The kernel's lock does not depend on the text. It is for people, for messages, and for
  // processes that have no locks on this disk.
  const std::string text = TextOf(IdentityOf(::getpid())) + "\n";
  if (::ftruncate(fd, 0) != 0 || !Write(fd, text)) {
    const Error error =
        OutputError(fmt::format("{}: cannot be written: {}", path.string(), std::strerror(errno)));
    lock.Remove();  // on a full disk nothing is left behind
    return error;
  }
  // A process with locks and one without both write first, and then look for each other.
  ::fdatasync(fd);
  LF_RETURN_IF_ERROR(LockClaim::CheckNone(path));
  return std::optional<FileLock>(std::move(lock));
}

Result<FileLock> FileLock::Take(const std::filesystem::path& path) {
  while (true) {
    const int fd = OpenLockFile(path);
    if (fd < 0) return CannotBeCreated(path);
    LF_ASSIGN_OR_RETURN(std::optional<FileLock> lock, TakeOpenFile(path, fd));
    if (lock) return std::move(*lock);
  }
}

Result<FileLock> FileLock::TakeInFolder(const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / "lock";
  while (true) {
    LF_RETURN_IF_ERROR(CreateFolder(folder));
    const int fd = OpenLockFile(path);
    if (fd < 0 && errno == ENOENT) continue;  // the folder was removed a moment ago
    if (fd < 0) return CannotBeCreated(path);
    LF_ASSIGN_OR_RETURN(std::optional<FileLock> lock, TakeOpenFile(path, fd));
    if (lock) return std::move(*lock);
  }
}

}  // namespace lf
