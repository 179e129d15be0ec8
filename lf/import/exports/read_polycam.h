// SPDX-License-Identifier: Apache-2.0
// Reads the raw data that Polycam exports (Export > Raw data): doc/formats/polycam.md. Each image
// has a file with its camera in keyframes/corrected_cameras/ or, if Polycam did not optimise the
// poses, in keyframes/cameras/. Poses are those of ARKit: world from camera, in metres, with y up
// and the camera axes x right, y up, z backwards.
#pragma once

#include <filesystem>
#include <string_view>

#include "lf/core/result.h"
#include "lf/import/exports/export_cameras.h"

namespace lf {

// Parses the camera of one image, which is named after the file:
//   fx, fy, cx, cy, width, height    in pixels from the upper left corner
//   t_00 ... t_23                    the upper three rows of world_from_cam
// kInput names the file, the key and the value.
Result<ExportedImage> ParsePolycamCamera(std::string_view text, const std::filesystem::path& file);

// Reads all cameras in the folder of `file`. The images are in corrected_images/ beside
// corrected_cameras/, or in images/ beside cameras/. Warns about the latter, whose lenses have a
// distortion that Polycam does not state.
Result<LightField> ReadPolycam(const std::filesystem::path& file, const ExportOptions& options);

}  // namespace lf
