// SPDX-License-Identifier: Apache-2.0
// Reads the sfm_data.json of OpenMVG (doc/formats/openmvg.md).
#pragma once

#include <filesystem>
#include <string_view>

#include "lf/import/exports/export_cameras.h"

namespace lf {

// Reads the views that have a pose and a camera, in their order; the others are left out. A pose is
// rotation R, row by row, and centre c: x_cam = R (x_world - c), with the axes x right, y down, z
// forward. Pixel centres are at whole numbers. Models: pinhole, pinhole_radial_k1,
// pinhole_radial_k3, pinhole_brown_t2, fisheye. Images are named from root_path.
// kInput names the file, the entry, the value and what was expected: for other models (spherical),
// and for versions other than 0.x.
Result<ExportedCameras> ParseOpenMvg(std::string_view text, const std::filesystem::path& file);

Result<LightField> ReadOpenMvg(const std::filesystem::path& file, const ExportOptions& options);

}  // namespace lf
