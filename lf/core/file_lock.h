// One process at a time: a lock that the kernel holds, and lets go of when its process ends,
// however it ends.
#pragma once

#include <filesystem>
#include <memory>

#include "lf/core/result.h"

namespace lf {

class FileLock {
 public:
  // Locks the file, made if it is missing, without waiting. kOutput: another process (its number is
  // in the message) or another FileLock holds it, or it cannot be made.
  static Result<FileLock> Take(const std::filesystem::path& path);
  // Whether anybody holds it now. A file that is missing, or that we may not read, is not held.
  static bool IsHeld(const std::filesystem::path& path);
  FileLock(FileLock&& other) noexcept;
  FileLock& operator=(FileLock&& other) noexcept;
  ~FileLock();  // lets go; the file stays, unless RemoveInTheEnd() was called

  // For a program that is to hold the lock with us, as long as either lives.
  int fd() const { return fd_; }

  // Lets go, and removes the file.
  void Remove();
  void RemoveInTheEnd() { is_removed_in_the_end_ = true; }

 private:
  FileLock(std::filesystem::path path, int fd);
  std::filesystem::path path_;
  int fd_ = -1;
  bool is_removed_in_the_end_ = false;
};

}  // namespace lf
