// SPDX-License-Identifier: Apache-2.0
// Closes a file descriptor of the system.
#pragma once

#include <unistd.h>

#include <utility>

namespace lf {

class OpenFile {
 public:
  // Takes over a descriptor; -1: none, because the file could not be opened.
  explicit OpenFile(int fd) : fd_(fd) {}
  OpenFile(OpenFile&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  OpenFile& operator=(OpenFile&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  ~OpenFile() {
    if (fd_ >= 0) ::close(fd_);
  }
  int get() const { return fd_; }

 private:
  int fd_;
};

}  // namespace lf
