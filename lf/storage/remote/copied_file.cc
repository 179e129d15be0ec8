// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/remote/copied_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <string_view>
#include <utility>

#include "lf/core/file.h"
#include "lf/core/hash.h"
#include "lf/core/log.h"
#include "lf/storage/remote/store_url.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr uint64_t kMostBegin = uint64_t{1} << 62;
constexpr uint64_t kMostCount = uint64_t{4} << 30;

// Warns once in the life of the program.
void WarnOfLostCopy(const fs::path& path, int code) {
  static std::atomic<bool> has_warned = false;
  if (!has_warned.exchange(true))
    LogWarning("{}: cannot be written: {}; what is read from the server is not kept", path.string(),
               std::strerror(code));
}

bool IsRegularFile(int fd) {
  struct stat status {};
  return ::fstat(fd, &status) == 0 && S_ISREG(status.st_mode);
}

bool IsHole(std::string_view bytes) {
  return !bytes.empty() &&
         std::all_of(bytes.begin(), bytes.end(), [](char byte) { return byte == 0; });
}

}  // namespace

Result<CopiedFile> CopiedFile::Open(const fs::path& path, const std::optional<std::string>& url,
                                    const RemoteOptions& options) {
  constexpr int kReading = O_RDONLY | O_CLOEXEC | O_NONBLOCK;
  if (!url) {
    OpenFile file(::open(path.c_str(), kReading));
    if (file.get() < 0)
      return Error{KindOfReadFailure(errno),
                   fmt::format("{}: this part of the packed store cannot be read: {}",
                               path.string(), std::strerror(errno))};
    if (!IsRegularFile(file.get()))
      return InputError(
          fmt::format("{}: this part of the packed store cannot be read: it is no regular file",
                      path.string()));
    return CopiedFile(path, std::move(file), std::nullopt);
  }
  LF_ASSIGN_OR_RETURN(RemoteFile remote, RemoteFile::Open(*url, options));
  constexpr mode_t kOwnerOnly = 0600;
  OpenFile file(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NONBLOCK, kOwnerOnly));
  const bool is_kept = file.get() >= 0 && IsRegularFile(file.get());
  if (!is_kept) {
    WarnOfLostCopy(path, file.get() < 0 ? errno : EINVAL);
    file = OpenFile(::open(path.c_str(), kReading));
    if (file.get() >= 0 && !IsRegularFile(file.get())) file = OpenFile(-1);
  }
  CopiedFile copied(path, std::move(file), std::move(remote));
  copied.is_kept_ = is_kept;
  return copied;
}

uint64_t CopiedFile::local_bytes() const {
  struct stat status {};
  if (file_.get() < 0 || ::fstat(file_.get(), &status) != 0) return 0;
  return static_cast<uint64_t>(status.st_size);
}

Result<RangeState> CopiedFile::Read(uint64_t begin, uint64_t count, uint64_t hash,
                                    std::string* into) {
  if (begin > kMostBegin || count > kMostCount)
    return InputError(
        fmt::format("{}: {} bytes from byte {} on are listed, which is more than a "
                    "file may have: the store is damaged; copy or make it again",
                    path_.string(), count, begin));
  const size_t before = into->size();
  Result<RangeState> state = ReadLocal(begin, count, hash, into);
  if (state && *state != RangeState::kRead && remote_ && count > 0) {
    into->resize(before);
    state = Fetch(begin, count, hash, into);
  }
  if (!state || *state != RangeState::kRead) into->resize(before);
  return state;
}

Result<RangeState> CopiedFile::ReadLocal(uint64_t begin, uint64_t count, uint64_t hash,
                                         std::string* into) {
  const uint64_t size_bytes = local_bytes();
  if (count > 0 && (begin > size_bytes || count > size_bytes - begin)) {
    complaint_ = fmt::format(
        "{}: has {} bytes, but an LF image is in the bytes {} to {}: the copy is incomplete; copy "
        "the file again",
        path_.string(), size_bytes, begin, begin + count);
    return RangeState::kNotThere;
  }
  const size_t before = into->size();
  into->resize(before + count);
  for (uint64_t got = 0; got < count;) {
    const ssize_t step = ::pread(file_.get(), into->data() + before + got, count - got,
                                 static_cast<off_t>(begin + got));
    if (step < 0 && errno == EINTR) continue;
    if (step < 0)
      return Error{KindOfReadFailure(errno),
                   fmt::format("{}: cannot be read: {}", path_.string(), std::strerror(errno))};
    if (step == 0) break;  // another process has made the file shorter
    got += static_cast<uint64_t>(step);
  }
  const std::string_view bytes = std::string_view(*into).substr(before);
  if (HashBytes(bytes) == hash) return RangeState::kRead;
  if (IsHole(bytes)) {
    complaint_ = fmt::format(
        "{}: the bytes {} to {} were never copied: the copy is incomplete; copy the file again",
        path_.string(), begin, begin + count);
    return RangeState::kNotThere;
  }
  complaint_ =
      fmt::format("{}: is damaged: a wrong checksum in the bytes {} to {}; copy the file again",
                  path_.string(), begin, begin + count);
  return RangeState::kDamaged;
}

Result<RangeState> CopiedFile::Fetch(uint64_t begin, uint64_t count, uint64_t hash,
                                     std::string* into) {
  constexpr int kMostFetches = 2;
  std::string bytes;
  for (int i = 0; i < kMostFetches; ++i) {
    const Result<void> read = remote_->Read(begin, count, &bytes);
    const TransferFault fault = remote_->fault();
    if (fault == TransferFault::kNotThere || fault == TransferFault::kBeyondEnd) {
      complaint_ = read.error().message;
      return RangeState::kNotThere;
    }
    LF_RETURN_IF_ERROR(read);
    if (HashBytes(bytes) != hash) continue;
    KeepRange(begin, bytes);
    if (into->empty())
      *into = std::move(bytes);
    else
      into->append(bytes);
    return RangeState::kRead;
  }
  complaint_ = fmt::format(
      "{}: is damaged on the server: a wrong checksum in the bytes {} to {}, also when they were "
      "read again; copy the file to the server again",
      ShownUrl(remote_->url()), begin, begin + count);
  return RangeState::kDamaged;
}

void CopiedFile::KeepRange(uint64_t begin, const std::string& bytes) {
  for (size_t written = 0; is_kept_ && written < bytes.size();) {
    const ssize_t step = ::pwrite(file_.get(), bytes.data() + written, bytes.size() - written,
                                  static_cast<off_t>(begin + written));
    if (step < 0 && errno == EINTR) continue;
    if (step < 0) {
      WarnOfLostCopy(path_, errno);
      is_kept_ = false;
      return;
    }
    written += static_cast<size_t>(step);
  }
}

}  // namespace lf
