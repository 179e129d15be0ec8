// SPDX-License-Identifier: Apache-2.0
// A lock file, which lets only one process at a time work in a folder, for example. The kernel
// holds the lock, and releases it when the process ends, even if the process is killed.
#pragma once

#include <filesystem>
#include <optional>

#include "lf/core/result.h"

namespace lf {

class FileLock {
 public:
  // Locks the file, and creates it if it is missing. If it cannot be written, it is removed.
  // kOutput if another process (the message gives its number) or another FileLock holds the lock,
  // or if the file cannot be created, locked or written. Waits a few milliseconds for the lock, and
  // up to a second for a process that has locked the file to write its number.
  static Result<FileLock> Take(const std::filesystem::path& path);
  // Creates the folder if it is missing, and takes the lock of the file FOLDER/lock. Other
  // processes may remove the folder whenever it is empty: it is then created again. kOutput as for
  // Take(), or if the folder cannot be created.
  static Result<FileLock> TakeInFolder(const std::filesystem::path& folder);
  // True if any process holds the lock now. False if none does, if the file is missing, or if this
  // process may not read it.
  static bool IsHeld(const std::filesystem::path& path);
  FileLock(FileLock&& other) noexcept;
  FileLock& operator=(FileLock&& other) noexcept;
  ~FileLock();  // releases the lock; the file stays, unless RemoveInTheEnd() was called

  // Descriptor of the file. A child process that inherits the descriptor shares the lock, which
  // lasts until both processes have closed it.
  int fd() const { return fd_; }

  // Removes the file and releases the lock.
  void Remove();
  void RemoveInTheEnd() { is_removed_in_the_end_ = true; }

 private:
  FileLock(std::filesystem::path path, int fd);
  // Locks the file that is open as `fd`, and takes over `fd`. Returns nullopt if the file was
  // removed in the meantime.
  static Result<std::optional<FileLock>> TakeOpenFile(const std::filesystem::path& path, int fd);
  std::filesystem::path path_;
  int fd_ = -1;
  bool is_removed_in_the_end_ = false;
};

}  // namespace lf
