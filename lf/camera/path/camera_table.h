// SPDX-License-Identifier: Apache-2.0
// Shows the cameras of a path as text, for lfcammvminfo and lfpath.
#pragma once

#include <string>
#include <vector>

#include "lf/camera/path/camera_path.h"
#include "lf/core/ids.h"

namespace lf {

// Returns one line for each fact about the camera (such as its position) that is the same in all
// frames, then a table of the other facts: one line per frame, with aligned columns below two
// header lines for the names of the facts and of their parts, such as x, y and z. Numbers have five
// digits.
std::string CameraTable(const CameraPath& path, const std::vector<FrameId>& frames);

// Returns the facts about the camera of one frame, one per line.
std::string CameraBlock(const CameraPath& path, FrameId frame);

// Returns comma-separated values: one line per frame below a header line, with all digits; infinity
// is "inf".
std::string CameraCsv(const CameraPath& path, const std::vector<FrameId>& frames);

// Returns {"fps", "frames", "first_frame", "resolution", "unit_m", "cameras": [{"frame": 1, ...},
// ...]} with all digits; infinity is null. "frames" is the number of frames of the path,
// "first_frame" the number of its first one; "cameras" has only the given `frames`.
std::string CameraJson(const CameraPath& path, const std::vector<FrameId>& frames);

}  // namespace lf
