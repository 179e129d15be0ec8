// SPDX-License-Identifier: Apache-2.0
// Writes a camera path as our own YAML file (doc/formats/path.md).
#pragma once

#include <string>
#include <vector>

#include "lf/camera/path/camera_path.h"
#include "lf/core/result.h"

namespace lf {

struct PathYaml {
  std::string text;
  // Phrases about what the file cannot hold, such as "the shape of the elements of 3 frames".
  std::vector<std::string> lost;
};

// Returns the text of a path whose cameras are the given ones at the times of the frames; between
// these times they move smoothly. A quantity that never changes is stated once. Reading the text
// returns the same cameras but for rounding errors. If there is a shutter, the cameras of its
// instants follow from the cameras of the frames. Lost are: elements that are no squares, skew, and
// blades, ratio, hood and transmission where they differ from those of the first frame by more than
// rounding errors. kOutput: the file would exceed the limits of its reader, such as some 20,000
// frames that move in every respect.
Result<PathYaml> PathYamlOf(const CameraPath& path);

}  // namespace lf
