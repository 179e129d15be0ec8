// What calibrations without an image size ask of image files: names, and sizes from headers.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "lf/core/result.h"

namespace lf {

// [width, height] of an image file.
using ImageSizeSource = std::function<Result<std::array<int, 2>>(const std::filesystem::path&)>;

// From the header of the file (imageio's ReadImageInfo).
Result<std::array<int, 2>> ImageSizeInHeader(const std::filesystem::path& image);

// By the extension, in any case: png, jpg, jpeg, tif, tiff, exr, and those of IsRawName().
bool IsImageName(std::string_view file_name);

// Names of the image files of a folder, sorted by bytes; hidden ones left out. kInput if it cannot
// be listed.
Result<std::vector<std::string>> SortedImageNames(const std::filesystem::path& folder);

}  // namespace lf
