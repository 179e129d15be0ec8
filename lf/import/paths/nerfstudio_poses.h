// SPDX-License-Identifier: Apache-2.0
// Reads the poses that `ns-export cameras` of nerfstudio writes, transforms_train.json and
// transforms_eval.json (doc/formats/foreign_paths.md):
//
//   [{"file_path": "images/a.png", "transform": [[4 numbers], [4 numbers], [4 numbers]]}, ...]
//
// transform is the matrix from camera to world, with OpenGL's camera axes, in the space in which
// nerfstudio trained. The file states no intrinsics. Internal to this folder.
#pragma once

#include <filesystem>
#include <string_view>

#include "lf/core/result.h"
#include "lf/import/paths/foreign_path.h"

namespace lf {

// Returns a frame for each pose, in the order of the file. The trained space is not undone.
// kInput names the file and the frame, the value found and what was expected.
Result<ForeignPath> ParseNerfstudioPoses(std::string_view text, const std::filesystem::path& file,
                                         const PathOptions& options);

// Reads a file, and undoes the space in which nerfstudio trained (UndoTraining()).
Result<ForeignPath> ReadNerfstudioPoses(const std::filesystem::path& file,
                                        const PathOptions& options);

}  // namespace lf
