// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/files/whole_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <string_view>

#include "lf/pixels/files/file_bytes.h"
#include "lf/pixels/files/image_probe.h"
#include "lf/pixels/files/tiff_directories.h"

namespace lf {
namespace {

// Reads a number, the least significant byte first, as in EXR; none if the number lies beyond the
// end of the file.
template <class T>
std::optional<T> LittleEndian(const ByteSource& source, uint64_t offset) {
  std::array<uint8_t, sizeof(T)> bytes;
  if (source(offset, bytes) != bytes.size()) return std::nullopt;
  uint64_t value = 0;
  for (size_t i = 0; i < bytes.size(); ++i) value |= uint64_t{bytes[i]} << (8 * i);
  return static_cast<T>(value);
}

// Reads a name, which ends with a zero byte, and moves `offset` behind it. Returns none if the file
// ends first or the name has more than 255 letters.
std::optional<std::string> Name(const ByteSource& source, uint64_t* offset) {
  constexpr size_t kLongestName = 255;
  std::array<uint8_t, kLongestName + 1> bytes;
  const size_t count = source(*offset, bytes);
  const auto end = std::find(bytes.begin(), bytes.begin() + count, 0);
  if (end == bytes.begin() + count) return std::nullopt;
  *offset += static_cast<uint64_t>(end - bytes.begin()) + 1;
  return std::string(bytes.begin(), end);
}

// Returns the number of rows in a block, for the number that stands for the compression in the file
// (OpenEXR, "File Layout"); none for an unknown number.
std::optional<int64_t> RowsOfBlock(uint8_t compression) {
  constexpr int64_t kRows[] = {1, 1, 1, 16, 32, 16, 32, 32, 32, 256};
  if (compression >= std::size(kRows)) return std::nullopt;
  return kRows[compression];
}

struct ExrHeader {
  uint64_t end = 0;  // offset behind the header, where the table of offsets begins
  int64_t row_count = 0;
  int64_t rows_of_block = 0;
};

// Reads the header. Returns none if it is damaged, or of a kind that is not written here: tiles,
// several parts, or deep samples.
std::optional<ExrHeader> ReadHeader(const ByteSource& source) {
  constexpr uint32_t kLongNames = 0x400, kVersion = 2;
  const auto version = LittleEndian<uint32_t>(source, 4);
  if (!version || (*version & ~kLongNames) != kVersion) return std::nullopt;
  std::optional<int64_t> rows, of_block;
  uint64_t offset = 8;
  while (true) {
    const auto name = Name(source, &offset);
    if (!name) return std::nullopt;
    if (name->empty()) break;
    const auto type = Name(source, &offset);
    const auto size = LittleEndian<uint32_t>(source, offset);
    offset += sizeof(uint32_t);
    if (!type || !size) return std::nullopt;
    if (*name == "dataWindow" && *type == "box2i" && *size == 16) {
      const auto first = LittleEndian<int32_t>(source, offset + 4);
      const auto last = LittleEndian<int32_t>(source, offset + 12);
      if (!first || !last) return std::nullopt;
      rows = int64_t{*last} - *first + 1;
    }
    if (*name == "compression" && *type == "compression" && *size == 1) {
      const auto compression = LittleEndian<uint8_t>(source, offset);
      if (!compression) return std::nullopt;
      of_block = RowsOfBlock(*compression);
    }
    offset += *size;
  }
  if (!rows || *rows < 1 || !of_block) return std::nullopt;
  return ExrHeader{offset, *rows, *of_block};
}

Result<void> CheckExr(const ByteSource& source, uint64_t size_bytes, const std::string& name) {
  const auto damaged = [&](const std::string& what) {
    return InputError(fmt::format("{}: EXR file is incomplete: {}", name, what));
  };
  const std::optional<ExrHeader> header = ReadHeader(source);
  if (!header)
    return damaged("its header is damaged, or describes tiles, several parts or deep data");
  const int64_t blocks = (header->row_count + header->rows_of_block - 1) / header->rows_of_block;
  if (static_cast<uint64_t>(blocks) > size_bytes / sizeof(uint64_t))
    return damaged("it ends within its table of offsets");
  const uint64_t first = header->end + static_cast<uint64_t>(blocks) * sizeof(uint64_t);
  for (int64_t block = 0; block < blocks; ++block) {
    const auto offset = LittleEndian<uint64_t>(
        source, header->end + static_cast<uint64_t>(block) * sizeof(uint64_t));
    if (!offset) return damaged("it ends within its table of offsets");
    const auto missing = [&] {
      return damaged(fmt::format("block {} of {} is missing", block + 1, blocks));
    };
    // A block consists of the number of its first row, the length of its content, and its content.
    constexpr uint64_t kBlockHeader = 8;
    if (*offset < first || *offset > size_bytes - std::min(size_bytes, kBlockHeader))
      return missing();
    const auto length = LittleEndian<uint32_t>(source, *offset + 4);
    if (!length || *length > size_bytes - *offset - kBlockHeader) return missing();
  }
  return {};
}

Result<void> CheckJpeg(const ByteSource& source, uint64_t size_bytes, const std::string& name) {
  std::array<uint8_t, 2> end;
  if (size_bytes > 2 && source(size_bytes - 2, end) == 2 && end[0] == 0xff && end[1] == 0xd9)
    return {};
  return InputError(fmt::format("{}: JPEG file is incomplete: it has no end mark (ff d9)", name));
}

}  // namespace

Result<void> CheckIsWhole(const ByteSource& source, uint64_t size_bytes, const std::string& name) {
  LF_ASSIGN_OR_RETURN(const ImageFormat format, ProbeImage(source, name));
  switch (format) {
    case ImageFormat::kExr:
      return CheckExr(source, size_bytes, name);
    case ImageFormat::kPng:
      return CheckPngIsComplete(source, name);
    case ImageFormat::kJpeg:
      return CheckJpeg(source, size_bytes, name);
    case ImageFormat::kTiff:
      if (FirstTiffDirectory(source)) return {};
      return InputError(fmt::format("{}: TIFF file is incomplete: its directory is missing", name));
    default:
      break;
  }
  return InputError(fmt::format("{}: is a {} file: expected a PNG, JPEG, TIFF or EXR file", name,
                                NameOf(format)));
}

Result<void> CheckFileIsWhole(const std::filesystem::path& path) {
  DiskFile file(path);
  Result<void> whole;
  if (file.error() == 0)
    whole = CheckIsWhole(
        [&file](uint64_t offset, std::span<uint8_t> to) { return file.Read(offset, to); },
        file.size_bytes(), path.string());
  if (file.error() != 0)
    return InputError(
        fmt::format("{}: cannot be read: {}", path.string(), std::strerror(file.error())));
  return whole;
}

}  // namespace lf
