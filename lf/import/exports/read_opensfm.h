// SPDX-License-Identifier: Apache-2.0
// Reads the reconstruction.json of OpenSfM and OpenDroneMap (doc/formats/opensfm.md).
#pragma once

#include <filesystem>
#include <string_view>

#include "lf/import/exports/export_cameras.h"

namespace lf {

// Reads the shots of the reconstruction that has most of them, in the order of their names; other
// reconstructions have no common world with it, and are left out with a warning. A shot states
// x_cam = R x_world + t, with the axes x right, y down, z forward, and R as the vector axis *
// angle. With s = max(width, height), a position (x, y) of the image plane is the pixel (w / 2 + s
// x, h / 2 + s y); focal lengths and principal points are stated as x and y. Models: perspective,
// simple_radial, radial, brown, fisheye, fisheye_opencv, fisheye62, fisheye624, and dual with a
// transition of 0 or 1. kInput names the file, the shot or camera, the value and what was expected:
// for cameras of other models (spherical, dual), and for parameters of fisheye62 and fisheye624
// that no model of camera/distortion.h has.
Result<ExportedCameras> ParseOpenSfm(std::string_view text, const std::filesystem::path& file);

// Images are looked for in images/ beside the file or beside its folder, and in its folder.
Result<LightField> ReadOpenSfm(const std::filesystem::path& file, const ExportOptions& options);

}  // namespace lf
