// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/packed/part_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "lf/core/file.h"
#include "lf/core/hash.h"
#include "lf/storage/tables/stored_numbers.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr size_t kNumbersPerRange = 3;
constexpr uint64_t kMostBegin = uint64_t{1} << 62;
constexpr uint64_t kMostRangeBytes = uint64_t{1} << 32;

// The head is text, so that `head -c 64` shows what the file is.
std::string HeadOf(const std::string& store, size_t number) {
  std::string head = fmt::format("lfrendertools part {} of the packed store {}", number, store);
  head.resize(kPartHeadBytes - 1, ' ');
  return head + "\n";
}

std::string SystemReason() { return std::strerror(errno); }

// Reads bytes at a position. Returns their number, which is smaller than wanted only at the end of
// the file; nullopt, with the reason in errno, if the file cannot be read.
std::optional<size_t> ReadAt(int fd, uint64_t begin, size_t wanted, char* bytes) {
  size_t done = 0;
  while (done < wanted) {
    const ssize_t n = ::pread(fd, bytes + done, wanted - done, static_cast<off_t>(begin + done));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return std::nullopt;
    if (n == 0) break;
    done += static_cast<size_t>(n);
  }
  return done;
}

// Returns the first bytes of a part; shorter if the file is.
std::string HeadIn(int fd) {
  std::string head(kPartHeadBytes, '\0');
  head.resize(ReadAt(fd, 0, head.size(), head.data()).value_or(0));
  return head;
}

// Returns the size of a regular file; nullopt for anything else.
std::optional<uint64_t> SizeOf(int fd) {
  struct stat status {};
  if (::fstat(fd, &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
  return static_cast<uint64_t>(status.st_size);
}

Error IsNotOfStore(const fs::path& path, size_t number, const std::string& store) {
  return InputError(
      fmt::format("{}: is not part {} of the packed store with the id {}: copy all files of one "
                  "store together, and keep their names",
                  path.string(), number, store));
}

}  // namespace

std::string TextOfRanges(const ImageRanges& ranges) {
  std::vector<uint64_t> numbers;
  const auto add = [&](const PartRange& range) {
    numbers.insert(numbers.end(), {range.begin, range.bytes, range.hash});
  };
  add(ranges.mask);
  for (const PartRange& piece : ranges.pieces) add(piece);
  return BytesOf(std::span<const uint64_t>(numbers));
}

std::optional<ImageRanges> RangesOfText(std::string_view text, size_t part_count) {
  constexpr size_t kRangeBytes = kNumbersPerRange * sizeof(uint64_t);
  if (text.size() % kRangeBytes != 0 || text.size() < 2 * kRangeBytes ||
      text.size() > (1 + part_count) * kRangeBytes)
    return std::nullopt;
  const std::vector<uint64_t> numbers = NumbersOf<uint64_t>(text);
  ImageRanges ranges;
  for (size_t i = 0; i < numbers.size(); i += kNumbersPerRange) {
    const PartRange range = {numbers[i], numbers[i + 1], numbers[i + 2]};
    if (range.begin > kMostBegin || range.bytes > kMostRangeBytes) return std::nullopt;
    if (i == 0)
      ranges.mask = range;
    else
      ranges.pieces.push_back(range);
  }
  return ranges;
}

fs::path PartPath(const fs::path& store, size_t number) {
  return store.parent_path() /
         fmt::format("{}-r{}{}", store.stem().string(), number, store.extension().string());
}

std::string StoreOfPart(const fs::path& path) {
  const OpenFile file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (file.get() < 0 || !SizeOf(file.get())) return {};
  const std::string head = HeadIn(file.get());
  for (size_t number = 0; number < kMostParts; ++number) {
    const std::string before = HeadOf("", number);
    const size_t begin = before.find_last_not_of(" \n") + 2;
    if (!head.starts_with(before.substr(0, begin))) continue;
    return head.substr(begin, head.find_first_of(" \n", begin) - begin);
  }
  return {};
}

Result<PartWriter> PartWriter::Open(const fs::path& path, const std::string& store, size_t number,
                                    uint64_t bytes) {
  OpenFile file(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666));
  const std::optional<uint64_t> size = file.get() < 0 ? std::nullopt : SizeOf(file.get());
  if (!size)
    return OutputError(
        fmt::format("{}: cannot be opened for writing: {}", path.string(), SystemReason()));
  if (bytes > 0 && HeadIn(file.get()) != HeadOf(store, number))
    return IsNotOfStore(path, number, store);
  if (*size < bytes)
    return InputError(fmt::format(
        "{}: has {} bytes, but {} were written to this part of the unfinished store: start the "
        "store again with {{lfcompressor overwrite}}",
        path.string(), *size, bytes));
  if (::ftruncate(file.get(), static_cast<off_t>(bytes)) != 0)
    return OutputError(fmt::format("{}: cannot be written: {}", path.string(), SystemReason()));
  PartWriter writer(std::move(file), path, bytes);
  if (bytes == 0) LF_RETURN_IF_ERROR(writer.Write(HeadOf(store, number)));
  return writer;
}

Result<void> PartWriter::Write(std::string_view bytes) {
  is_flushed_ = false;
  while (!bytes.empty()) {
    const ssize_t n = ::pwrite(file_.get(), bytes.data(), bytes.size(), static_cast<off_t>(bytes_));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0)
      return OutputError(fmt::format("{}: cannot be written: {}", path_.string(), SystemReason()));
    bytes_ += static_cast<uint64_t>(n);
    bytes.remove_prefix(static_cast<size_t>(n));
  }
  return {};
}

Result<PartRange> PartWriter::Add(std::string_view bytes) {
  const PartRange range = {bytes_, bytes.size(), HashBytes(bytes)};
  LF_RETURN_IF_ERROR(Write(bytes));
  return range;
}

Result<void> PartWriter::Flush() {
  if (is_flushed_) return {};
  if (::fdatasync(file_.get()) != 0)
    return OutputError(
        fmt::format("{}: cannot be flushed to the disk: {}", path_.string(), SystemReason()));
  is_flushed_ = true;
  return {};
}

Result<PartReader> PartReader::Open(const fs::path& path, const std::string& store, size_t number) {
  OpenFile file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  const std::optional<uint64_t> size = file.get() < 0 ? std::nullopt : SizeOf(file.get());
  if (!size) {
    const ErrorKind kind = file.get() < 0 ? KindOfReadFailure(errno) : ErrorKind::kInput;
    return Error{kind,
                 fmt::format("{}: this part of the packed store cannot be read: {}", path.string(),
                             file.get() < 0 ? SystemReason() : "it is no regular file")};
  }
  // A copy that was cut off in the head has none of the LF images.
  if (!HeadOf(store, number).starts_with(HeadIn(file.get())))
    return IsNotOfStore(path, number, store);
  return PartReader(std::move(file), path, *size);
}

Result<void> PartReader::Read(const PartRange& range, std::string* into) const {
  if (range.end() > bytes_)
    return InputError(fmt::format(
        "{}: has {} bytes, but an LF image is in the bytes {} to {}: the copy is incomplete; copy "
        "the file again",
        path_.string(), bytes_, range.begin, range.end()));
  const size_t before = into->size();
  into->resize(before + range.bytes);
  const std::optional<size_t> got =
      ReadAt(file_.get(), range.begin, range.bytes, into->data() + before);
  if (!got)
    return Error{KindOfReadFailure(errno),
                 fmt::format("{}: cannot be read: {}", path_.string(), SystemReason())};
  if (*got < range.bytes || HashBytes(std::string_view(*into).substr(before)) != range.hash)
    return InputError(
        fmt::format("{}: is damaged: a wrong checksum in the bytes {} to {}; copy the file again",
                    path_.string(), range.begin, range.end()));
  return {};
}

}  // namespace lf
