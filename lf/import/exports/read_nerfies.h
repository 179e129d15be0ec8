// SPDX-License-Identifier: Apache-2.0
// Reads the data sets of nerfies and HyperNeRF: camera/ID.json beside rgb/1x/ID.png
// (doc/formats/nerfies.md).
#pragma once

#include <filesystem>
#include <string_view>

#include "lf/import/exports/export_cameras.h"

namespace lf {

// Reads one camera: orientation R, row by row, and position c, x_cam = R (x_world - c), with the
// axes x right, y down, z forward; fx = focal_length, fy = focal_length pixel_aspect_ratio;
// radial_distortion k1 k2 k3 and tangential_distortion p1 p2 of kRadialTangential. Pixel centres
// are at half integers. The name of the image is that of the file without .json. kInput names the
// file, the key, the value and what was expected.
Result<ExportedImage> ParseNerfiesCamera(std::string_view text, const std::filesystem::path& file);

// Reads the data set of which `file` is a camera. If the folder above has a dataset.json with a
// list "ids", the cameras are those of the list; otherwise, all in the folder. The depth range is
// near / scale to far / scale of scene.json, if it is there. Images are looked for in rgb/1x,
// rgb/2x, rgb/4x, rgb/8x and rgb/16x.
Result<LightField> ReadNerfies(const std::filesystem::path& file, const ExportOptions& options);

}  // namespace lf
