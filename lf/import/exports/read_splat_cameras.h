// SPDX-License-Identifier: Apache-2.0
// Reads the cameras.json that programs of 3D Gaussian splatting write
// (doc/formats/splat_cameras.md).
#pragma once

#include <filesystem>
#include <string_view>

#include "lf/import/exports/export_cameras.h"

namespace lf {

// Reads a list of cameras:
//   [{"img_name": "a", "width": 800, "height": 600, "position": [x, y, z],
//     "rotation": [[...], [...], [...]], "fx": 700, "fy": 700}, ...]
// rotation is world_from_cam, with the camera's axes right, down, forward; position is the centre.
// The principal point is the middle of the image. kInput names the file, the entry, the value and
// what was expected.
Result<ExportedCameras> ParseSplatLightField(std::string_view text,
                                             const std::filesystem::path& file);

// Images are looked for in images/ beside the file, in its folder, and in the folders below.
Result<LightField> ReadSplatLightField(const std::filesystem::path& file,
                                       const ExportOptions& options);

}  // namespace lf
