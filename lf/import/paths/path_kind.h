// SPDX-License-Identifier: Apache-2.0
// Finds out in which form a camera path is written. Internal to this folder.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "lf/core/result.h"

namespace lf {

enum class PathKind {
  kYaml,
  kNerfstudio,
  kNerfstudioPoses,
  kNgp,
  kChan,
  kTransforms,
  kSplatCameras,
  kColmap
};

// A path, with its form: `path` is the file or, for kColmap, the folder of the model.
struct PathPlace {
  PathKind kind = PathKind::kYaml;
  std::filesystem::path path;
};

// Returns the keys of the top level of a JSON object, in the order of the text; those before the
// first error if the text is not JSON. Empty if the text begins with something other than {.
std::vector<std::string> TopLevelKeys(std::string_view text);

// Returns the form of a text. kInput if it is JSON of no known form: the message lists the keys
// that were found and those that were expected; or if it is a file of another kind (other_files.h).
//   file  for messages; its extension is used if the content does not tell the form
Result<PathKind> PathKindOf(std::string_view text, const std::filesystem::path& file);

// Finds the path that a file or folder holds. In a folder, this is transforms.json or a COLMAP
// model (FindColmapModel()). A file of a COLMAP model stands for its folder. A file that cannot be
// opened counts as our own, whose reader reports the error. kInput: an error of PathKindOf(); a
// folder without a path; a file of a COLMAP model without the others.
Result<PathPlace> FindPath(const std::filesystem::path& path);

}  // namespace lf
