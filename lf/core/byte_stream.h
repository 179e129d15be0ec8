// The bytes of a file from front to back, a block at a time: files larger than memory.
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
  // kInput if the file cannot be opened or is no regular file.
  static Result<ByteStream> Open(const std::filesystem::path& path);
  // Of bytes in memory, which must outlive it; `path` is for messages.
  ByteStream(std::string_view bytes, std::filesystem::path path);

  ByteStream(ByteStream&& other) noexcept;
  ByteStream(const ByteStream&) = delete;
  ByteStream& operator=(const ByteStream&) = delete;
  ByteStream& operator=(ByteStream&&) = delete;
  ~ByteStream();

  const std::filesystem::path& path() const { return path_; }
  uint64_t position() const { return window_end_ - window_.size(); }
  uint64_t remaining() const { return size_ - position(); }

  // The next bytes, as many as are in memory but at least one; empty only at the end, or where the
  // file cannot be read (Status). Valid until the next call of another function.
  std::string_view Window() {
    Fill(1);
    return window_;
  }
  // count <= remaining(). Where that leads out of the window, nothing is read.
  void Skip(uint64_t count);

  // The next number, little-endian as all of COLMAP's. False, and nothing taken, where fewer bytes
  // are left.
  template <class T>
  bool Take(T* value) {
    static_assert(std::endian::native == std::endian::little);
    if (!Fill(sizeof(T))) return false;
    std::memcpy(value, window_.data(), sizeof(T));
    window_.remove_prefix(sizeof(T));
    return true;
  }

  // kInput with the system's reason if reading failed or the file became shorter meanwhile.
  Result<void> Status() const;

 private:
  ByteStream(int fd, uint64_t size, std::filesystem::path path);
  // Whether the window holds `count` bytes, after reading what it takes.
  bool Fill(size_t count) { return window_.size() >= count || ReadMore(count); }
  bool ReadMore(size_t count);

  std::filesystem::path path_;
  int fd_ = -1;  // none: in memory
  uint64_t size_ = 0;
  std::vector<char> block_;
  std::string_view window_;  // unread bytes, of block_ or of the memory
  uint64_t window_end_ = 0;  // where the window ends in the file
  std::string failure_;
};

}  // namespace lf
