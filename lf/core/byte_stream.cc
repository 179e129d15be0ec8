// SPDX-License-Identifier: Apache-2.0
#include "lf/core/byte_stream.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <utility>

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr size_t kBlockSize = size_t{1} << 20;

}  // namespace

Result<ByteStream> ByteStream::Open(const fs::path& path) {
  // O_NONBLOCK, because opening a named pipe would wait for its writer.
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (fd < 0)
    return InputError(fmt::format("{}: cannot be opened: {}", path.string(), std::strerror(errno)));
  struct stat status = {};
  if (::fstat(fd, &status) != 0 || !S_ISREG(status.st_mode)) {
    ::close(fd);
    return InputError(fmt::format("{}: is a folder or a device, expected a file", path.string()));
  }
  return ByteStream(fd, static_cast<uint64_t>(status.st_size), path);
}

ByteStream::ByteStream(int fd, uint64_t size, fs::path path)
    : path_(std::move(path)), fd_(fd), size_(size), block_(kBlockSize) {}

ByteStream::ByteStream(std::string_view bytes, fs::path path)
    : path_(std::move(path)), size_(bytes.size()), window_(bytes), window_end_(bytes.size()) {}

// The window stays valid: moving a vector keeps its memory.
ByteStream::ByteStream(ByteStream&& other) noexcept
    : path_(std::move(other.path_)),
      fd_(std::exchange(other.fd_, -1)),
      size_(other.size_),
      block_(std::move(other.block_)),
      window_(other.window_),
      window_end_(other.window_end_),
      failure_(std::move(other.failure_)) {}

ByteStream::~ByteStream() {
  if (fd_ >= 0) ::close(fd_);
}

void ByteStream::Skip(uint64_t count) {
  LF_CHECK(count <= remaining());
  if (count <= window_.size()) {
    window_.remove_prefix(count);
    return;
  }
  window_end_ += count - window_.size();
  window_ = {};
}

bool ByteStream::ReadMore(size_t count) {
  LF_CHECK(count <= kBlockSize);
  if (fd_ < 0 || count > remaining() || !failure_.empty()) return false;
  if (!window_.empty()) std::memmove(block_.data(), window_.data(), window_.size());
  size_t held = window_.size();
  while (held < count) {
    const ssize_t got =
        ::pread(fd_, block_.data() + held, block_.size() - held, static_cast<off_t>(window_end_));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) {
      failure_ = got < 0 ? std::strerror(errno) : "it became shorter while it was read";
      break;
    }
    held += static_cast<size_t>(got);
    window_end_ += static_cast<uint64_t>(got);
  }
  // Ignores bytes that were appended to the file after it was opened.
  if (window_end_ > size_) {
    held -= std::min<uint64_t>(held, window_end_ - size_);
    window_end_ = size_;
  }
  window_ = std::string_view(block_.data(), held);
  return held >= count;
}

Result<void> ByteStream::Status() const {
  if (failure_.empty()) return {};
  return InputError(
      fmt::format("{}: cannot be read at byte {}: {}", path_.string(), window_end_, failure_));
}

}  // namespace lf
