// SPDX-License-Identifier: Apache-2.0
// Reads the data sets of MVSNet and its successors: cams/ID_cam.txt beside images/ID.jpg
// (doc/formats/mvsnet.md).
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "lf/import/exports/export_cameras.h"

namespace lf {

// One file of a camera.
struct MvsnetCamera {
  ExportedImage image;                    // without a size
  std::optional<DepthRange> depth_range;  // set if the last line states the farthest depth
};

// Reads one camera: the word extrinsic and a matrix of 4 x 4 numbers, x_cam = R x_world + t, with
// the axes x right, y down, z forward; the word intrinsic and a matrix K of 3 x 3 numbers; a line
//   DEPTH_MIN DEPTH_INTERVAL [DEPTH_COUNT [DEPTH_MAX]]
// Pixel centres are at half integers. The name of the image is that of the file without _cam.txt.
// kInput names the file, the line, the value and what was expected.
Result<MvsnetCamera> ParseMvsnetCamera(std::string_view text, const std::filesystem::path& file);

// Reads the data set of which `file` is a camera. Images are looked for in images/ and
// blended_images/ beside the folder of the cameras, beside the cameras, and below. The depth range
// covers those of all cameras. If the principal points are a quarter of those that the size of the
// images calls for, as in data for training, the intrinsics are multiplied by 4, with a warning.
Result<LightField> ReadMvsnet(const std::filesystem::path& file, const ExportOptions& options);

}  // namespace lf
