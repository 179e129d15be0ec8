// SPDX-License-Identifier: Apache-2.0
// Reads recordings of Record3D: the file metadata of an unpacked .r3d, or the metadata.json of an
// export as EXR and RGB files (doc/formats/record3d.md). Poses are those of ARKit: world from
// camera, in metres, with the camera axes x right, y up, z backwards.
#pragma once

#include <filesystem>
#include <string_view>

#include "lf/core/result.h"
#include "lf/import/exports/export_cameras.h"

namespace lf {

// Parses the text of a file. Image i is named rgbd/i.jpg.
//   w, h                     size of the images in pixels
//   K                        calibration matrix, column by column: fx 0 0 skew fy 0 cx cy 1
//   perFrameIntrinsicCoeffs  fx, fy, cx and cy of each image, in place of K
//   poses                    qx qy qz qw x y z of each image
// kInput names the file, the key and the value; other numbers of poses and of intrinsics; a K that
// is written row by row.
//   file  for messages; its folder is that from which the names of the images lead
Result<ExportedCameras> ParseRecord3d(std::string_view text, const std::filesystem::path& file);

// Reads a file as ParseRecord3d() does. The images are those in rgbd/, rgb/ or images/ beside it,
// or in its folder, whose names are their numbers. If other numbers are there, but as many as
// poses, images and poses have the same order.
Result<LightField> ReadRecord3d(const std::filesystem::path& file, const ExportOptions& options);

}  // namespace lf
