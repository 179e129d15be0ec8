// SPDX-License-Identifier: Apache-2.0
// Reads the cameras of a calibration as the frames of a film, such as views that were held out of a
// reconstruction (doc/formats/foreign_paths.md). Internal to this folder.
#pragma once

#include <filesystem>
#include <string_view>

#include "lf/core/result.h"
#include "lf/import/paths/foreign_path.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// Returns a frame for each LF camera, in their order. Frames have no lens distortion; a warning
// tells if LF cameras do.
//   file  for messages
// kInput: images of different sizes, unless options.resolution_px is set.
Result<ForeignPath> FramesOf(const LightField& light_field, const std::filesystem::path& file,
                             const PathOptions& options);

// Reads a transforms.json, or the COLMAP model in a folder (FindColmapModel()).
Result<ForeignPath> ReadTransformsFrames(const std::filesystem::path& file,
                                         const PathOptions& options);
Result<ForeignPath> ReadColmapFrames(const std::filesystem::path& model_folder,
                                     const PathOptions& options);

// Reads the cameras.json that programs of 3D Gaussian splatting write:
//   [{"img_name": "a", "width": 800, "height": 600, "position": [x, y, z],
//     "rotation": [[...], [...], [...]], "fx": 700, "fy": 700}, ...]
// rotation is world_from_cam, with the camera's axes right, down, forward.
Result<ForeignPath> ParseSplatCameras(std::string_view text, const std::filesystem::path& file,
                                      const PathOptions& options);
Result<ForeignPath> ReadSplatCameras(const std::filesystem::path& file, const PathOptions& options);

}  // namespace lf
