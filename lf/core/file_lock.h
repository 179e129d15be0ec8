// A lock file, with which one process works at a time. The kernel holds the lock, and releases it
// when the process ends, however it ends.
#pragma once

#include <filesystem>
#include <memory>

#include "lf/core/result.h"

namespace lf {

class FileLock {
 public:
  // Locks the file without waiting, and creates it if it is missing. kOutput if another process
  // (the message gives its number) or another FileLock holds the lock, or if the file cannot be
  // created, locked or written.
  static Result<FileLock> Take(const std::filesystem::path& path);
  // True if anybody holds the lock now. False if the file is missing or may not be read by us.
  static bool IsHeld(const std::filesystem::path& path);
  FileLock(FileLock&& other) noexcept;
  FileLock& operator=(FileLock&& other) noexcept;
  ~FileLock();  // releases the lock; the file stays, unless RemoveInTheEnd() was called

  // Descriptor of the file. A program that inherits it holds the lock with us: the lock lasts as
  // long as one of the two processes has it open.
  int fd() const { return fd_; }

  // Removes the file and releases the lock.
  void Remove();
  void RemoveInTheEnd() { is_removed_in_the_end_ = true; }

 private:
  FileLock(std::filesystem::path path, int fd);
  std::filesystem::path path_;
  int fd_ = -1;
  bool is_removed_in_the_end_ = false;
};

}  // namespace lf
