// SPDX-License-Identifier: Apache-2.0
// Writes a camera path as a scene of USD in its text form, .usda (doc/formats/foreign_paths.md).
// Internal to this folder.
#pragma once

#include <string>
#include <string_view>

#include "lf/camera/path/camera_path.h"

namespace lf {

// The first lines of every scene that UsdaText() returns.
inline constexpr std::string_view kUsdaStart = "#usda 1.0\n(\n    defaultPrim = \"camera\"\n";

// Returns the text of a scene with one camera, "/camera", whose time codes are the numbers of the
// frames. Lengths of the optics are tenths of a world unit, as USD requires; the focus distance is
// in world units.
std::string UsdaText(const CameraPath& path);

}  // namespace lf
