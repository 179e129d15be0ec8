// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/files/view_array.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "lf/pixels/files/file_bytes.h"
#include "lf/pixels/files/hdf5_array.h"
#include "lf/pixels/files/npy_head.h"
#include "lf/pixels/files/picture_decoder.h"
#include "lf/pixels/files/views_shape.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

Result<std::string> ReadStart(DiskFile* disk, const fs::path& file) {
  std::string start(std::min<uint64_t>(disk->size_bytes(), kMostNpyHeadBytes), '\0');
  start.resize(disk->Read(0, {reinterpret_cast<uint8_t*>(start.data()), start.size()}));
  if (disk->error() == 0) return start;
  return InputError(
      fmt::format("{}: cannot be read: {}", file.string(), std::strerror(disk->error())));
}

bool HasShapeOfViews(const NpyHead& head) {
  return head.shape.size() == 4 || head.shape.size() == 5;
}

// Sets the type of the values. Returns false for a type that is not read.
bool SetType(std::string_view descr, ViewArray* array) {
  if (descr.size() != 3 || (descr[0] != '<' && descr[0] != '>' && descr[0] != '|')) return false;
  const std::string_view kind = descr.substr(1);
  if (kind != "u1" && kind != "u2" && kind != "f4" && kind != "f8") return false;
  array->value_bytes = kind[1] - '0';
  array->is_big_endian = descr[0] == '>';
  array->info.is_float = kind[0] == 'f';
  array->info.bits = array->info.is_float ? 32 : 8 * array->value_bytes;
  return true;
}

// Returns true if the file begins as HDF5 files do.
bool IsHdf5(DiskFile* disk) {
  std::string start(8, '\0');
  start.resize(disk->Read(0, {reinterpret_cast<uint8_t*>(start.data()), start.size()}));
  return IsHdf5Start(start);
}

Result<ViewArray> ArrayOf(DiskFile* disk, const fs::path& file) {
  LF_ASSIGN_OR_RETURN(const std::string start, ReadStart(disk, file));
  return ParseViewArray(start, disk->size_bytes(), file.string());
}

// Converts `count` numbers of type From to values of type To.
template <class From, class To>
void Convert(const uint8_t* bytes, size_t count, bool is_big_endian, To* to) {
  const bool swaps = is_big_endian != (std::endian::native == std::endian::big);
  for (size_t i = 0; i < count; ++i) {
    uint8_t raw[sizeof(From)];
    std::memcpy(raw, bytes + i * sizeof(From), sizeof(From));
    if (swaps) std::reverse(raw, raw + sizeof(From));
    From value;
    std::memcpy(&value, raw, sizeof(From));
    to[i] = static_cast<To>(value);
  }
}

// Reads the pixels `rect` of a view.
//   begin  offset of the view
template <class From, class To>
Result<void> ReadPixels(DiskFile* disk, const std::string& name, const ViewArray& array,
                        uint64_t begin, const PixelRect& rect, StoredImage* image) {
  const auto channels = static_cast<size_t>(array.info.channels);
  Image<To>& pixels = Resized<To>(rect.width(), rect.height(), array.info.channels, image);
  std::vector<uint8_t> row(static_cast<size_t>(rect.width()) * channels * sizeof(From));
  for (int y = rect.y_begin; y < rect.y_end; ++y) {
    const uint64_t first = (static_cast<uint64_t>(y) * static_cast<uint64_t>(array.info.width) +
                            static_cast<uint64_t>(rect.x_begin)) *
                           channels;
    if (disk->Read(begin + first * sizeof(From), row) != row.size())
      return InputError(fmt::format("{}: truncated while it was read", name));
    Convert<From>(row.data(), row.size() / sizeof(From), array.is_big_endian,
                  pixels.row(y - rect.y_begin));
  }
  return {};
}

}  // namespace

Result<ViewArray> ParseViewArray(std::string_view start, uint64_t size_bytes,
                                 const std::string& name) {
  const Result<NpyHead> parsed = ParseNpyHead(start);
  if (!parsed) return InputError(fmt::format("{}: {}", name, parsed.error().message));
  const NpyHead& head = *parsed;
  ViewArray array;
  LF_RETURN_IF_ERROR(SetShapeOfViews(head.shape, head.fortran_order, name, &array));
  if (!SetType(head.descr, &array))
    return InputError(fmt::format(
        "{}: holds numbers of the type '{}': expected uint8, uint16, float32 or float64; convert "
        "the array with astype",
        name, ShownNpyText(head.descr)));
  LF_ASSIGN_OR_RETURN(const size_t count, NpyValueCount(head.shape));
  const uint64_t bytes = count * static_cast<uint64_t>(array.value_bytes);
  if (size_bytes - head.values_begin != bytes)
    return InputError(
        fmt::format("{}: has {} bytes of numbers, but its shape ({}) takes {}: copy or "
                    "save it again",
                    name, size_bytes - head.values_begin, fmt::join(head.shape, ", "), bytes));
  array.values_begin = head.values_begin;
  return array;
}

bool HoldsViewArray(const fs::path& file) {
  DiskFile disk(file);
  const Result<std::string> start = ReadStart(&disk, file);
  if (!start) return false;
  const Result<NpyHead> head = ParseNpyHead(*start);
  return head && HasShapeOfViews(*head);
}

Result<ViewArray> ReadViewArray(const fs::path& file) {
  DiskFile disk(file);
  if (IsHdf5(&disk)) return ReadHdf5Array(file);
  return ArrayOf(&disk, file);
}

Result<void> ReadArrayPart(const fs::path& file, int row, int column, const WantedPixels& wanted,
                           ImagePart* part) {
  DiskFile disk(file);
  if (IsHdf5(&disk)) return ReadHdf5Part(file, row, column, wanted, part);
  LF_ASSIGN_OR_RETURN(const ViewArray array, ArrayOf(&disk, file));
  const std::string name = file.string();
  LF_ASSIGN_OR_RETURN(const PixelRect rect, BeginArrayPart(array, row, column, name, wanted, part));
  const uint64_t view_bytes =
      static_cast<uint64_t>(array.info.width) * static_cast<uint64_t>(array.info.height) *
      static_cast<uint64_t>(array.info.channels) * static_cast<uint64_t>(array.value_bytes);
  const uint64_t index = static_cast<uint64_t>(row) * static_cast<uint64_t>(array.columns) +
                         static_cast<uint64_t>(column);
  const uint64_t begin = array.values_begin + index * view_bytes;
  StoredImage* const image = &part->image;
  if (array.value_bytes == 1)
    return ReadPixels<uint8_t, uint8_t>(&disk, name, array, begin, rect, image);
  if (array.value_bytes == 2)
    return ReadPixels<uint16_t, uint16_t>(&disk, name, array, begin, rect, image);
  if (array.value_bytes == 4)
    return ReadPixels<float, float>(&disk, name, array, begin, rect, image);
  return ReadPixels<double, float>(&disk, name, array, begin, rect, image);
}

}  // namespace lf
