// SPDX-License-Identifier: Apache-2.0
// The exposure that an image file states, in its Exif data or as LibRaw reads it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "lf/core/result.h"

namespace lf {

// A value is missing if the file does not state it; otherwise it is above 0 and finite.
struct ExposureFacts {
  std::optional<double> time_s;
  std::optional<double> f_number;
  std::optional<double> iso;
};

// Reads the header alone: the Exif data of JPEG, TIFF, PNG, WebP and HEIF files; for camera raw
// files, what LibRaw reads from them. Other files state no exposure. Errors are as for
// ReadImageInfo() (image_file.h), except that damaged Exif data count as missing.
Result<ExposureFacts> ReadExposureFacts(const std::filesystem::path& path);

// Reads the exposure from a file that is in memory; messages call the file `name`.
Result<ExposureFacts> ReadExposureFactsBytes(std::string_view bytes, const std::string& name);

}  // namespace lf
