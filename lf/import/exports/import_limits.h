// SPDX-License-Identifier: Apache-2.0
// Names and limits that the readers of all formats share. Internal to import/exports and
// import/formats.
#pragma once

#include <cstddef>

namespace lf {

inline constexpr const char* kImagesName =
    "images";  // name of the folder of image files, beside the calibration file
inline constexpr size_t kMaxImageCount = size_t{1} << 24;
inline constexpr double kLargest_w = 1e12;  // largest coordinate of a camera, as in transforms.json

}  // namespace lf
