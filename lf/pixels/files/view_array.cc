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
#include "lf/pixels/files/npy_head.h"
#include "lf/pixels/files/picture_decoder.h"

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
  const std::vector<size_t>& shape = head.shape;
  const size_t channels = shape.size() == 5 ? shape[4] : 1;
  if (!HasShapeOfViews(head) || head.fortran_order || channels > 4)
    return InputError(fmt::format(
        "{}: holds an array of the shape ({}){}: expected the views of a grid of cameras, (rows, "
        "columns, height, width) or (rows, columns, height, width, channels) in C order with up to "
        "4 channels",
        name, fmt::join(shape, ", "), head.fortran_order ? " in Fortran order" : ""));
  if (!SetType(head.descr, &array))
    return InputError(fmt::format(
        "{}: holds numbers of the type '{}': expected uint8, uint16, float32 or float64; convert "
        "the array with astype",
        name, ShownNpyText(head.descr)));
  const Result<size_t> count = NpyValueCount(shape);
  if (!count) return InputError(fmt::format("{}: {}", name, count.error().message));
  LF_RETURN_IF_ERROR(CheckPictureSize(static_cast<int64_t>(shape[3]),
                                      static_cast<int64_t>(shape[2]),
                                      static_cast<int64_t>(channels), name));
  const uint64_t bytes = *count * static_cast<uint64_t>(array.value_bytes);
  if (size_bytes - head.values_begin != bytes)
    return InputError(
        fmt::format("{}: has {} bytes of numbers, but its shape ({}) takes {}: copy or "
                    "save it again",
                    name, size_bytes - head.values_begin, fmt::join(shape, ", "), bytes));
  array.rows = static_cast<int>(shape[0]);
  array.columns = static_cast<int>(shape[1]);
  array.info.height = static_cast<int>(shape[2]);
  array.info.width = static_cast<int>(shape[3]);
  array.info.channels = static_cast<int>(channels);
  array.info.channel_names = channels < 3 ? std::vector<std::string>{"Y", "A"}
                                          : std::vector<std::string>{"R", "G", "B", "A"};
  array.info.channel_names.resize(channels);
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
  return ArrayOf(&disk, file);
}

Result<void> ReadArrayPart(const fs::path& file, int row, int column, const WantedPixels& wanted,
                           ImagePart* part) {
  DiskFile disk(file);
  LF_ASSIGN_OR_RETURN(const ViewArray array, ArrayOf(&disk, file));
  if (row >= array.rows || column >= array.columns)
    return InputError(fmt::format(
        "{}: has {} rows and {} columns of views, but row {} and column {}, counted from 0, are "
        "asked for: is it another array than when the calibration was written?",
        file.string(), array.rows, array.columns, row, column));
  LF_ASSIGN_OR_RETURN(const PixelRect asked, wanted(array.info));
  const PixelRect rect = Intersection(asked, {0, 0, array.info.width, array.info.height});
  part->info = array.info;
  part->icc_profile.clear();
  part->rect = rect;
  const uint64_t view_bytes =
      static_cast<uint64_t>(array.info.width) * static_cast<uint64_t>(array.info.height) *
      static_cast<uint64_t>(array.info.channels) * static_cast<uint64_t>(array.value_bytes);
  const uint64_t index = static_cast<uint64_t>(row) * static_cast<uint64_t>(array.columns) +
                         static_cast<uint64_t>(column);
  const uint64_t begin = array.values_begin + index * view_bytes;
  const std::string name = file.string();
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
