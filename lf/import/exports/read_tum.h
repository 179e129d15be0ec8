// SPDX-License-Identifier: Apache-2.0
// Reads trajectories in the form of TUM's RGB-D benchmark, which many SLAM programs write
// (doc/formats/tum.md).
#pragma once

#include <filesystem>
#include <string_view>

#include "lf/import/exports/export_cameras.h"

namespace lf {

// Reads a trajectory, "time x y z qx qy qz qw" on each line, and a list of images, "time name" on
// each line; times are in seconds. A pose is world_from_cam, with the camera's axes right, down,
// forward. The pose of an image is that of its time, between the two poses around it (linear
// position, spherically linear rotation) if these are at most 0.1 s apart, and otherwise the
// nearest pose within 0.02 s. Images without a pose are left out. All cameras have the focal length
// `focal_px`, and the principal point in the middle of the image.
//   list_file  the path of the list, for messages
// kInput names the file, the line, the value and what was expected; times that do not increase.
Result<ExportedCameras> ParseTum(std::string_view text, const std::filesystem::path& file,
                                 std::string_view list, const std::filesystem::path& list_file,
                                 double focal_px);

// The list is rgb.txt beside the file. kInput if it is not there, or if options.focal_px is not
// given.
Result<LightField> ReadTum(const std::filesystem::path& file, const ExportOptions& options);

}  // namespace lf
