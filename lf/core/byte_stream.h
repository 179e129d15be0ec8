// SPDX-License-Identifier: Apache-2.0
// Reads a file from front to back, one block at a time, so that the file may be larger than memory.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "lf/core/result.h"

namespace lf {

class ByteStream {
 public:
  // Opens a file. kInput if the file cannot be opened or is no regular file.
  static Result<ByteStream> Open(const std::filesystem::path& path);
  // Reads bytes in memory, which must outlive this object. `path` is for messages only.
  ByteStream(std::string_view bytes, std::filesystem::path path);

  ByteStream(ByteStream&& other) noexcept;
  ByteStream(const ByteStream&) = delete;
  ByteStream& operator=(const ByteStream&) = delete;
  ByteStream& operator=(ByteStream&&) = delete;
  ~ByteStream();

  const std::filesystem::path& path() const { return path_; }
  uint64_t position() const { return window_end_ - window_.size(); }
  uint64_t remaining() const { return size_ - position(); }

  // Returns the unread bytes that are in memory; reads a block first if there are none. The result
  // is empty only at the end of the file, or if the file cannot be read (see Status()). The result
  // is valid until Skip() or Take() is called.
  std::string_view Window() {
    Fill(1);
    return window_;
  }
  // Skips `count` bytes, which must be at most remaining(). Reads nothing from the file, even if
  // `count` is larger than the window.
  void Skip(uint64_t count);

  // Reads the next number and advances past it. The number is little-endian, as in COLMAP's files.
  // Returns false and does not advance if too few bytes are left or the file cannot be read.
  template <class T>
  bool Take(T* value) {
    static_assert(std::endian::native == std::endian::little);
    if (!Fill(sizeof(T))) return false;
    std::memcpy(value, window_.data(), sizeof(T));
    window_.remove_prefix(sizeof(T));
    return true;
  }

  // Returns kInput if reading failed (with the system's reason), or if the file has become shorter
  // since it was opened.
  Result<void> Status() const;

 private:
  ByteStream(int fd, uint64_t size, std::filesystem::path path);
  // Reads more if the window holds fewer than `count` bytes. Returns true if the window then holds
  // `count` bytes or more.
  bool Fill(size_t count) { return window_.size() >= count || ReadMore(count); }
  bool ReadMore(size_t count);

  std::filesystem::path path_;
  int fd_ = -1;  // descriptor of the file; -1: the bytes are in memory
  uint64_t size_ = 0;
  std::vector<char> block_;
  std::string_view window_;  // unread bytes, in block_ or in the caller's memory
  uint64_t window_end_ = 0;  // position in the file where the window ends
  std::string failure_;
};

}  // namespace lf
