// SPDX-License-Identifier: Apache-2.0
// Writes a camera path as a scene of USD in its text form, .usda (doc/formats/foreign_paths.md).
// Internal to this folder.
#pragma once

#include <string>

#include "lf/camera/path/camera_path.h"

namespace lf {

// Returns the text of a scene with one camera, "/camera", whose time codes are the frames. Lengths
// of the optics are tenths of a world unit, as USD requires; the focus distance is in world units.
std::string UsdaText(const CameraPath& path);

}  // namespace lf
