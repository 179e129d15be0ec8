// The cameras of a path as text: for lfcammvminfo.
#pragma once

#include <string>
#include <vector>

#include "lf/core/ids.h"
#include "lf/path/camera_path.h"

namespace lf {

// What is the same in all frames, a line per fact; below it a table of what changes, a line per
// frame, columns aligned under two header lines: names and parts. Five digits.
std::string CameraTable(const CameraPath& path, const std::vector<FrameId>& frames);

// One frame, a line per fact.
std::string CameraBlock(const CameraPath& path, FrameId frame);

// One line per frame under a header line, all digits; "inf" is infinite.
std::string CameraCsv(const CameraPath& path, const std::vector<FrameId>& frames);

// {"fps", "frames", "resolution", "unit_m", "cameras": [{"frame": 1, ...}, ...]}, all digits;
// infinite numbers are null.
std::string CameraJson(const CameraPath& path, const std::vector<FrameId>& frames);

}  // namespace lf
