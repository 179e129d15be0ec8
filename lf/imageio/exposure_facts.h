// The exposure that an image file states, by Exif or as LibRaw reads it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "lf/core/result.h"

namespace lf {

// Each is missing where the file does not state it, and above 0 and finite otherwise.
struct ExposureFacts {
  std::optional<double> time_s;
  std::optional<double> f_number;
  std::optional<double> iso;
};

// Reads the header alone: Exif data of JPEG, TIFF and PNG files; what LibRaw tells of camera raw
// files. EXR files state nothing. kInput as for ReadImageInfo().
Result<ExposureFacts> ReadExposureFacts(const std::filesystem::path& path);

// The same for a file that is in memory; `name` is what messages call it.
Result<ExposureFacts> ReadExposureFactsBytes(std::string_view bytes, const std::string& name);

}  // namespace lf
