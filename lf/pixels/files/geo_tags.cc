// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/files/geo_tags.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <system_error>

#include "lf/core/file.h"
#include "lf/core/parse_number.h"
#include "lf/pixels/files/file_bytes.h"
#include "lf/pixels/files/libtiff_handle.h"

namespace lf {
namespace {

constexpr uint32_t kPixelScale = 33550, kTiePoints = 33922, kTransformation = 34264,
                   kGeoKeys = 34735, kNodata = 42113;
constexpr size_t kMostValues = 1 << 16;

// Returns the values of a tag, which must have the type T; none if the file has no such tag.
template <class T>
Result<std::span<const T>> ValuesOf(const LibtiffHandle& handle, const std::string& name,
                                    uint32_t tag, TIFFDataType type) {
  const TIFFField* const field = TIFFFindField(handle.tiff(), tag, TIFF_ANY);
  if (field == nullptr) return std::span<const T>();
  uint32_t count = 0;
  const void* values = nullptr;
  if (TIFFFieldDataType(field) != type || TIFFFieldPassCount(field) == 0 ||
      TIFFFieldReadCount(field) != TIFF_VARIABLE2 ||
      TIFFGetField(handle.tiff(), tag, &count, &values) != 1 || values == nullptr ||
      count > kMostValues)
    return InputError(
        fmt::format("{}: the TIFF tag {} has not the type that GeoTIFF gives it: "
                    "expected type {}, at most {} values",
                    name, tag, static_cast<int>(type), kMostValues));
  return std::span(static_cast<const T*>(values), count);
}

// Returns the value of a key of the directory of geo keys that is stored in the directory itself; 0
// if it is missing. The directory begins with four numbers, the last of which counts the keys, and
// has four for each key: key, place, count, value.
int KeyOf(std::span<const uint16_t> keys, uint16_t key) {
  for (size_t i = 4; i + 4 <= keys.size(); i += 4)
    if (keys[i] == key && keys[i + 1] == 0) return keys[i + 3];
  return 0;
}

class Reader {
 public:
  Reader(const LibtiffHandle& handle, const std::string& name) : handle_(handle), name_(name) {}

  Result<GeoTags> Read() {
    LF_ASSIGN_OR_RETURN(const std::span<const uint16_t> keys,
                        ValuesOf<uint16_t>(handle_, name_, kGeoKeys, TIFF_SHORT));
    constexpr uint16_t kModelType = 1024, kRasterType = 1025, kLinearUnit = 3076;
    constexpr int kGeographic = 2, kPoints = 2;
    tags_.is_geographic = KeyOf(keys, kModelType) == kGeographic;
    tags_.linear_unit = KeyOf(keys, kLinearUnit);
    corner_ = KeyOf(keys, kRasterType) == kPoints ? 0 : 0.5;
    LF_RETURN_IF_ERROR(ReadNodata());
    LF_ASSIGN_OR_RETURN(const std::span<const double> matrix,
                        ValuesOf<double>(handle_, name_, kTransformation, TIFF_DOUBLE));
    LF_RETURN_IF_ERROR(matrix.empty() ? ReadScaleAndTie() : ReadMatrix(matrix));
    const auto is_finite = [](const std::optional<std::array<double, 2>>& values) {
      return !values || (std::isfinite((*values)[0]) && std::isfinite((*values)[1]));
    };
    if (!is_finite(tags_.first_pixel) || !is_finite(tags_.pixel_size))
      return Fault("its coordinates are no finite numbers");
    return tags_;
  }

 private:
  Error Fault(const std::string& what) const {
    return InputError(fmt::format(
        "{}: GeoTIFF tags: {}: resample the picture to a map whose rows run from west to east and "
        "columns from north to south, or remove the tags",
        name_, what));
  }

  Result<void> ReadNodata() {
    LF_ASSIGN_OR_RETURN(const std::span<const char> text,
                        ValuesOf<char>(handle_, name_, kNodata, TIFF_ASCII));
    if (text.empty()) return {};
    std::string_view number(text.data(), text.size());
    // The text ends with a NUL, before which some programs write blanks.
    number = number.substr(0, number.find_last_not_of(std::string_view(" \0", 2)) + 1);
    const bool is_nan = number == "nan" || number == "NaN" || number == "NAN";
    const std::optional<double> value = is_nan ? std::nan("") : ParseNumber(number);
    if (!value)
      return InputError(fmt::format("{}: the TIFF tag {} (GDAL_NODATA) is '{}': expected a number",
                                    name_, kNodata, number));
    tags_.nodata = value;
    return {};
  }

  Result<void> SetSize(double across, double down) {
    if (!(across > 0) || !(down > 0))
      return Fault(fmt::format("its pixels measure {:g} x {:g} map units", across, down));
    tags_.pixel_size = {across, down};
    return {};
  }

  Result<void> ReadScaleAndTie() {
    LF_ASSIGN_OR_RETURN(const std::span<const double> scale,
                        ValuesOf<double>(handle_, name_, kPixelScale, TIFF_DOUBLE));
    LF_ASSIGN_OR_RETURN(const std::span<const double> tie,
                        ValuesOf<double>(handle_, name_, kTiePoints, TIFF_DOUBLE));
    if (!scale.empty()) {
      if (scale.size() < 2) return Fault("ModelPixelScaleTag has fewer than two values");
      LF_RETURN_IF_ERROR(SetSize(scale[0], scale[1]));
    }
    if (tie.empty()) return {};
    if (tie.size() % 6 != 0)
      return Fault(
          fmt::format("ModelTiepointTag has {} values, expected a multiple of 6", tie.size()));
    if (scale.empty()) return Fault("it has tie points, but no ModelPixelScaleTag");
    tags_.first_pixel = {tie[3] + (corner_ - tie[0]) * scale[0],
                         tie[4] - (corner_ - tie[1]) * scale[1]};
    return {};
  }

  // The matrix maps (column, row, 0, 1) to map coordinates, row by row.
  Result<void> ReadMatrix(std::span<const double> matrix) {
    if (matrix.size() != 16)
      return Fault(fmt::format("ModelTransformationTag has {} values, expected 16", matrix.size()));
    if (matrix[1] != 0 || matrix[4] != 0)
      return Fault("ModelTransformationTag turns or shears the picture");
    LF_RETURN_IF_ERROR(SetSize(matrix[0], -matrix[5]));
    tags_.first_pixel = {matrix[3] + corner_ * matrix[0], matrix[7] + corner_ * matrix[5]};
    return {};
  }

  const LibtiffHandle& handle_;
  const std::string& name_;
  double corner_ = 0.5;  // position of a pixel's middle, in pixels
  GeoTags tags_;
};

Result<GeoTags> ReadTags(const FileBytes& file) {
  uint8_t begin[4] = {};
  const bool is_tiff =
      file.read(0, begin) == 4 && ((begin[0] == 'I' && begin[1] == 'I' && begin[3] == 0) ||
                                   (begin[0] == 'M' && begin[1] == 'M' && begin[2] == 0));
  if (!is_tiff) return GeoTags();
  LF_ASSIGN_OR_RETURN(const std::unique_ptr<LibtiffHandle> handle, LibtiffHandle::OpenToRead(file));
  return Reader(*handle, file.name).Read();
}

}  // namespace

Result<GeoTags> ReadGeoTags(const std::filesystem::path& path) {
  DiskFile disk(path);
  const FileBytes file = {
      [&disk](uint64_t offset, std::span<uint8_t> to) { return disk.Read(offset, to); },
      disk.size_bytes(), path.string()};
  const auto failure = [&] {
    return Error{KindOfReadFailure(disk.error()),
                 fmt::format("{}: cannot be read: {}", path.string(),
                             std::generic_category().message(disk.error()))};
  };
  if (disk.error() != 0) return failure();
  Result<GeoTags> tags = ReadTags(file);
  if (disk.error() != 0) return failure();
  return tags;
}

Result<GeoTags> ReadGeoTagsBytes(std::string_view bytes, const std::string& name) {
  return ReadTags(FileInMemory(bytes, name));
}

}  // namespace lf
