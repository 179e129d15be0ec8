// SPDX-License-Identifier: Apache-2.0
// A lock file, which lets only one process at a time work in a folder, for example. The kernel
// holds the lock, and releases it when the process ends, even if the process is killed.
//
// On a disk without such locks (flock() fails with ENOSYS, ENOLCK or EOPNOTSUPP, as on Lustre that
// is mounted without flock), files in FILE.claims stand for the lock (lock_claims.h), and a warning
// says so once. A process that has locks and one that has none keep each other out: the former
// looks for claims, and the latter reads the lock file, which names the process that locked it.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <memory>
#include <optional>

#include "lf/core/result.h"

namespace lf {

class LockClaim;

class FileLock {
 public:
  // Locks the file, and creates it if it is missing. If it cannot be written, it is removed.
  // kOutput if another process (the message gives its number) or another FileLock holds the lock,
  // or if the file cannot be created, locked or written. Waits a few milliseconds for the lock, and
  // up to a second for a process that has locked the file to write its number. On a disk without
  // locks, waits up to half a minute if a process of another machine may have died.
  static Result<FileLock> Take(const std::filesystem::path& path);
  // Creates the folder if it is missing, and takes the lock of the file FOLDER/lock. Other
  // processes may remove the folder whenever it is empty: it is then created again. kOutput as for
  // Take(), or if the folder cannot be created.
  static Result<FileLock> TakeInFolder(const std::filesystem::path& folder);
  // True if any process holds the lock now. False if none does, if the file is missing, or if this
  // process may not read it. On a disk without locks, the process of another machine holds it
  // until its claim is old.
  static bool IsHeld(const std::filesystem::path& path);
  // True if `file` belongs to the lock `path`: the lock file itself, or the folder of its claims.
  // Whoever empties the folder of a lock must leave such files alone.
  static bool IsPart(const std::filesystem::path& path, const std::filesystem::path& file);
  FileLock(FileLock&& other) noexcept;
  FileLock& operator=(FileLock&& other) noexcept;
  ~FileLock();  // releases the lock; the file stays, unless RemoveInTheEnd() was called

  // Descriptor of the file; -1 on a disk without locks. A child process that inherits the
  // descriptor shares the lock, which lasts until both processes have closed it.
  int fd() const { return fd_; }
  // Notes in the file that a child process shares the lock. On a disk without locks, the lock then
  // lasts until both processes have ended, or until this one releases it. kOutput: it cannot be
  // written.
  Result<void> ShareWith(pid_t child);

  // Removes the file and releases the lock.
  void Remove();
  void RemoveInTheEnd() { is_removed_in_the_end_ = true; }

 private:
  FileLock(std::filesystem::path path, int fd);
  // Claims the lock, because the disk has no locks. Returns nullopt if the file was removed in the
  // meantime.
  static Result<std::optional<FileLock>> ClaimOpenFile(FileLock lock);
  // Releases the lock, and leaves the file without the number of this process.
  void Release();
  // Locks the file that is open as `fd`, and takes over `fd`. Returns nullopt if the file was
  // removed in the meantime.
  static Result<std::optional<FileLock>> TakeOpenFile(const std::filesystem::path& path, int fd);
  std::filesystem::path path_;
  int fd_ = -1;
  std::unique_ptr<LockClaim> claim_;  // on a disk without locks
  bool is_removed_in_the_end_ = false;
};

}  // namespace lf
