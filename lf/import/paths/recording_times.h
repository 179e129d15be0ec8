// SPDX-License-Identifier: Apache-2.0
// Paths that move through the time of a light field video (doc/formats/light_field_video.md).
#pragma once

#include <filesystem>
#include <vector>

#include "lf/camera/path/camera_path.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// Returns the recording times that the frames and instants of a path show, ascending; none if it
// does not move through time. The light field need not be open: OpenOptions::path_times takes the
// result. kInput: the path is our own YAML and cannot be read.
Result<std::vector<double>> RecordingTimesOf(const std::filesystem::path& path);
std::vector<double> RecordingTimesOf(const CameraPath& path);

// Makes a path fit a light field of one time: if only one slice is open, of those that the path
// asked for, its frames need no recording times, and they are removed, so that all modes and files
// of films serve. Does nothing if several slices are open. kUsage: the path moves through time, but
// the light field was opened for one time (OpenOptions::time), or is no light field video.
Result<void> FitToOpenTimes(const LightField& light_field, CameraPath* path);

}  // namespace lf
