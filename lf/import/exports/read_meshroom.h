// SPDX-License-Identifier: Apache-2.0
// Reads the cameras of Meshroom and AliceVision: cameras.sfm, sfm.json and other scenes in JSON
// (doc/formats/meshroom.md).
#pragma once

#include <filesystem>
#include <string_view>

#include "lf/import/exports/export_cameras.h"

namespace lf {

// Reads the views that have a pose, in their order; the others are left out. A pose is rotation R,
// column by column, and centre c: x_cam = R (x_world - c), with the axes x right, y down, z
// forward. Of a view in a rig, this is rig_from_world, and the rig states cam_from_rig in the same
// way. Pixel centres are at whole numbers.
//
// Intrinsics by version, for an image of w x h pixels and a sensor of the width S in mm:
//   below 1.2.1   principalPoint counts from the upper left corner; then from (w / 2, h / 2)
//   below 1.2.2   pxFocalLength in pixels: one number below 1.2.0, then [fx, fy]
//   below 1.2.5   fx = focalLength w / S, fy = fx / pixelRatio
//   below 1.2.11  fx = focalLength w / S, fy = fx pixelRatio
//   then          fy = focalLength max(w, h) / S, fx = fy / pixelRatio
// Lens models: pinhole; radial1, radial3, brown, fisheye4, fisheye1 (below 1.2.8), or the
// distortionType radialk1, radialk3, radialk3pt, brown, fisheye, fisheye1.
// kInput names the file, the entry, the value and what was expected: for a version other than 1.x,
// for equidistant cameras and for undistortion models of other programs (3DEqualizer).
Result<ExportedCameras> ParseMeshroom(std::string_view text, const std::filesystem::path& file);

Result<LightField> ReadMeshroom(const std::filesystem::path& file, const ExportOptions& options);

}  // namespace lf
