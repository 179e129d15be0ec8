// SPDX-License-Identifier: Apache-2.0
// Reads the models.json of Google's light field data sets (doc/formats/google_models.md): Spaces
// (16 cameras at several places) and Immersive Light Field Video (46 fish-eyes).
#pragma once

#include <filesystem>
#include <string_view>

#include "lf/core/result.h"
#include "lf/import/exports/export_cameras.h"

namespace lf {

// Parses the text of a file: a list of cameras, or of lists of cameras, of which each has
//   relative_path or name    the image
//   width, height            in pixels
//   focal_length, pixel_aspect_ratio, principal_point
//                            fx, fy / fx, and (cx, cy); (0.5, 0.5) is the centre of the upper left
//                            pixel
//   position                 camera centre, in metres
//   orientation              axis of the rotation cam_from_world, as long as its angle in radians
//   projection_type          "fisheye", or one of pinholes
//   radial_distortion        k1, k2 and 0 of a fish-eye: rd = theta (1 + k1 theta^2 + k2 theta^4)
// kInput names the file, the camera, the key and the value: a distortion of a pinhole, or a third
// coefficient, whose meaning is not documented.
//   file  for messages; its folder is that from which the paths lead
Result<ExportedCameras> ParseGoogleModels(std::string_view text, const std::filesystem::path& file);

// Reads a file as ParseGoogleModels() does.
Result<LightField> ReadGoogleModels(const std::filesystem::path& file,
                                    const ExportOptions& options);

}  // namespace lf
