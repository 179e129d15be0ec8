// SPDX-License-Identifier: Apache-2.0
// Reads and writes .chan files of Nuke (doc/formats/foreign_paths.md): lines of
//
//   frame  tx ty tz  rx ry rz  [vertical field of view]
//
// whose frame numbers are those of the path (CameraPath::first_frame), with camera-to-world
// translations and rotations in degrees of a camera with OpenGL's axes.
// Internal to this folder.
#pragma once

#include <filesystem>
#include <string>

#include "lf/core/byte_stream.h"
#include "lf/core/result.h"
#include "lf/import/paths/foreign_path.h"

namespace lf {

// Reads the lines of a stream. kInput names the file and the line, the value found and what was
// expected.
Result<ForeignPath> ParseChan(ByteStream stream, const PathOptions& options);
Result<ForeignPath> ReadChan(const std::filesystem::path& file, const PathOptions& options);

// Returns the text of a file.
std::string ChanText(const CameraPath& path, RotationOrder order);

}  // namespace lf
