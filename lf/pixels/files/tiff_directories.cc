// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/files/tiff_directories.h"

#include <algorithm>
#include <array>
#include <bit>
#include <span>

namespace lf {
namespace {

constexpr size_t kMaxEntryCount = 1024;

enum TiffType {
  kByte = 1,
  kShort = 3,
  kLong = 4,
  kRational = 5,
  kSignedByte = 6,
  kSignedShort = 8,
  kSignedLong = 9,
  kSignedRational = 10,
  kFloat = 11,
  kDouble = 12,
  kDirectory = 13,
  kLong8 = 16,
  kSignedLong8 = 17,
  kDirectory8 = 18
};

// Returns the size of a number of this TIFF type, in bytes; 0 if the type is not a number.
size_t BytesOf(int type) {
  switch (type) {
    case kByte:
    case kSignedByte:
      return 1;
    case kShort:
    case kSignedShort:
      return 2;
    case kLong:
    case kSignedLong:
    case kFloat:
    case kDirectory:
      return 4;
    case kRational:
    case kSignedRational:
    case kDouble:
    case kLong8:
    case kSignedLong8:
    case kDirectory8:
      return 8;
    default:
      return 0;
  }
}

uint64_t Unsigned(std::span<const uint8_t> bytes, bool little_endian) {
  uint64_t value = 0;
  for (size_t i = 0; i < bytes.size(); ++i)
    value = value << 8 | bytes[little_endian ? bytes.size() - 1 - i : i];
  return value;
}

double ValueOf(std::span<const uint8_t> bytes, int type, bool little_endian) {
  const auto number = [&](size_t begin, size_t count) {
    return Unsigned(bytes.subspan(begin, count), little_endian);
  };
  switch (type) {
    case kSignedByte:
      return static_cast<int8_t>(bytes[0]);
    case kSignedShort:
      return static_cast<int16_t>(number(0, 2));
    case kSignedLong:
      return static_cast<int32_t>(number(0, 4));
    case kSignedLong8:
      return static_cast<double>(static_cast<int64_t>(number(0, 8)));
    case kRational:
      return static_cast<double>(number(0, 4)) / static_cast<double>(number(4, 4));
    case kSignedRational:
      return static_cast<double>(static_cast<int32_t>(number(0, 4))) /
             static_cast<int32_t>(number(4, 4));
    case kFloat:
      return std::bit_cast<float>(static_cast<uint32_t>(number(0, 4)));
    case kDouble:
      return std::bit_cast<double>(number(0, 8));
    default:
      return static_cast<double>(number(0, bytes.size()));
  }
}

}  // namespace

std::vector<double> TiffDirectory::Numbers(int tag, size_t limit) const {
  const auto found = entries_.find(tag);
  if (found == entries_.end()) return {};
  const Entry& entry = found->second;
  const size_t value_bytes = BytesOf(entry.type);
  if (value_bytes == 0 || entry.count > limit) return {};
  std::vector<uint8_t> bytes(entry.count * value_bytes);
  if ((*source_)(entry.offset, bytes) != bytes.size()) return {};
  std::vector<double> values;
  for (size_t at = 0; at < bytes.size(); at += value_bytes)
    values.push_back(
        ValueOf(std::span(bytes).subspan(at, value_bytes), entry.type, little_endian_));
  return values;
}

double TiffDirectory::Number(int tag, double otherwise) const {
  constexpr size_t kMaxCount = 16;
  const std::vector<double> values = Numbers(tag, kMaxCount);
  return values.empty() ? otherwise : values[0];
}

class TiffReader {
 public:
  explicit TiffReader(const ByteSource& source) : source_(source) {
    constexpr uint64_t kClassic = 42, kBig = 43;
    std::array<uint8_t, 16> head{};
    const size_t size = source(0, head);
    if (size < 8) return;
    little_endian_ = head[0] == 'I';
    const uint64_t version = Unsigned(std::span(head).subspan(2, 2), little_endian_);
    is_big_ = version == kBig && size == head.size();
    if (version == kClassic || is_big_)
      first_ = Unsigned(std::span(head).subspan(OffsetBytes(), OffsetBytes()), little_endian_);
  }

  uint64_t first() const { return first_; }  // offset of the first directory; 0 if there is none

  // Returns the directory at `offset`; none if it is beyond the end of the file or has no tag.
  std::optional<TiffDirectory> ReadAt(uint64_t offset) const {
    std::vector<uint8_t> count_bytes(is_big_ ? 8 : 2);
    if (source_(offset, count_bytes) != count_bytes.size()) return std::nullopt;
    const size_t count = Unsigned(count_bytes, little_endian_);
    // An entry is the tag, the type, the number of values, and the values or their offset.
    const size_t entry_bytes = 4 + 2 * OffsetBytes();
    const uint64_t begin = offset + count_bytes.size();
    std::vector<uint8_t> bytes(std::min(count, kMaxEntryCount) * entry_bytes);
    bytes.resize(source_(begin, bytes) / entry_bytes * entry_bytes);
    if (bytes.empty()) return std::nullopt;
    TiffDirectory directory;
    directory.source_ = &source_;
    directory.little_endian_ = little_endian_;
    for (size_t at = 0; at < bytes.size(); at += entry_bytes)
      AddEntry(std::span(bytes).subspan(at, entry_bytes), begin + at, &directory);
    return directory;
  }

 private:
  // Returns the size of an offset, and of a number of values, in bytes.
  size_t OffsetBytes() const { return is_big_ ? 8 : 4; }

  void AddEntry(std::span<const uint8_t> bytes, uint64_t offset, TiffDirectory* directory) const {
    TiffDirectory::Entry entry;
    entry.type = static_cast<int>(Unsigned(bytes.subspan(2, 2), little_endian_));
    entry.count = Unsigned(bytes.subspan(4, OffsetBytes()), little_endian_);
    // Values that take no more bytes than an offset are stored in the entry itself.
    const size_t value_bytes = std::max<size_t>(1, BytesOf(entry.type));
    entry.offset = entry.count <= OffsetBytes() / value_bytes
                       ? offset + 4 + OffsetBytes()
                       : Unsigned(bytes.last(OffsetBytes()), little_endian_);
    directory->entries_.emplace(Unsigned(bytes.first(2), little_endian_), entry);
  }

  const ByteSource& source_;
  bool little_endian_ = true;
  bool is_big_ = false;  // true: a BigTIFF file, whose offsets have 64 bits instead of 32
  uint64_t first_ = 0;
};

std::optional<TiffDirectory> FirstTiffDirectory(const ByteSource& source) {
  const TiffReader reader(source);
  if (reader.first() == 0) return std::nullopt;
  return reader.ReadAt(reader.first());
}

std::optional<TiffDirectory> ExifDirectory(const ByteSource& source) {
  constexpr int kExifOffset = 0x8769;
  const TiffReader reader(source);
  const std::optional<TiffDirectory> first = FirstTiffDirectory(source);
  const double offset = first ? first->Number(kExifOffset, 0) : 0;
  if (!(offset >= 1)) return std::nullopt;
  return reader.ReadAt(static_cast<uint64_t>(offset));
}

}  // namespace lf
