// Names and limits that the readers of all formats share. Internal to this folder.
#pragma once

#include <cstddef>

namespace lf {

inline constexpr const char* kImagesName =
    "images";  // folder of the images, beside the calibration
inline constexpr size_t kMaxImageCount = size_t{1} << 24;
inline constexpr double kLargest_w = 1e12;  // largest coordinate, as in transforms.json

}  // namespace lf
