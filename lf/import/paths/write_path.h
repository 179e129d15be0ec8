// SPDX-License-Identifier: Apache-2.0
// Writes a camera path in any supported form.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lf/camera/path/camera_path.h"
#include "lf/core/result.h"
#include "lf/import/check/similarity.h"
#include "lf/import/paths/open_path.h"

namespace lf {

enum class PathFormat { kYaml, kNerfstudio, kNgp, kChan, kUsda };

// Returns the name of a format in options: yaml, nerfstudio, instant-ngp, chan, usda.
std::string_view NameOf(PathFormat format);
std::optional<PathFormat> PathFormatOf(std::string_view name);

// Returns the format that the extension of a file stands for: .yaml and .yml for our own, .json for
// nerfstudio, .chan and .usda for Nuke and USD. nullopt for other extensions.
std::optional<PathFormat> PathFormatOfFile(const std::filesystem::path& file);

// Returns true if a file of the format can say that the plate of a camera is shifted
// (camera.shift). In JSON, only our own programs read the shift.
bool HoldsShift(PathFormat format);

// Checks that a file of this name may be replaced by a path: it is missing, empty, or a camera path
// itself (our own YAML, a path of nerfstudio or instant-ngp, a .chan, or a .usda as we write it).
// All programs call it before they write a path. kUsage otherwise, for a calibration in particular.
// kInput: the file cannot be read, so that nobody knows.
Result<void> CheckReplacesPath(const std::filesystem::path& file);

// Writes a path.
//   options  nerfstudio: if dataparser_transforms is set, the cameras are moved into that trained
//            space; light_field as for OpenPath(). instant-ngp: ngp_scale and ngp_offset; by
//            default those of the light field's transforms.json, otherwise 0.33 and 0.5. .chan:
//            rotation_order
// Returns phrases about what the format cannot hold, such as "blades"; our own programs restore
// from JSON what is not named. kUsage: the path has several views of each moment, and the format
// does not hold the shift of their plates. kInput: an error of the dataparser_transforms. kOutput:
// the file cannot be written.
Result<std::vector<std::string>> WritePath(const CameraPath& path,
                                           const std::filesystem::path& file, PathFormat format,
                                           const PathOptions& options);

// Moves the cameras of a path into world b, their lenses included. The unit stays. kInput: a camera
// would be beyond 1e12, or a length of a lens beyond 1e9 world units.
Result<void> MovePath(const Similarity& b_from_a, const std::filesystem::path& file,
                      CameraPath* path);

}  // namespace lf
