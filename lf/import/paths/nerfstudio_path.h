// SPDX-License-Identifier: Apache-2.0
// Reads and writes camera paths of nerfstudio's viewer, camera_path.json
// (doc/formats/foreign_paths.md):
//
//   {"camera_type": "perspective", "render_width": 1920, "render_height": 1080, "fps": 24,
//    "seconds": 4, "camera_path": [{"camera_to_world": [16 numbers], "fov": 50}, ...]}
//
// camera_to_world is row-major, with OpenGL's camera axes, as one list or as a list of rows; fov is
// the vertical field of view in degrees. Internal to this folder.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "lf/core/result.h"
#include "lf/import/paths/foreign_path.h"
#include "lf/light_field/transforms_json/json_fields.h"

namespace lf {

// Reads a text. The trained space is not undone: the file's own space is that of the cameras.
//   is_world  set to true if the file says that its space is the world (lf_space)
// kInput names the file and the frame, the value found and what was expected.
Result<ForeignPath> ParseNerfstudioPath(std::string_view text, const std::filesystem::path& file,
                                        const PathOptions& options, bool* is_world);

// Reads a file, and undoes the space in which nerfstudio trained: by options.dataparser_transforms,
// or by a dataparser_transforms.json beside the file.
Result<ForeignPath> ReadNerfstudioPath(const std::filesystem::path& file,
                                       const PathOptions& options);

// Returns the pose that a matrix from camera to world states, 4x4 or 3x4: all numbers row by row,
// or a list of rows. kInput: the key is missing, or has no such matrix.
Result<RigidTransform> PoseOfMatrix(const JsonFields& frame, const char* key);

// Moves the cameras of a file from the space in which nerfstudio trained to the world of the light
// field, by options.dataparser_transforms or by a dataparser_transforms.json beside the file. If
// there is none, path->lacks says so.
//   is_world  the file says that its cameras are in the world; they are not moved
// kUsage: is_world is true, and options.dataparser_transforms is given. kInput: errors of
// WorldFromTrained().
Result<void> UndoTraining(const std::filesystem::path& file, const PathOptions& options,
                          bool is_world, ForeignPath* path);

// Returns the similarity that a dataparser_transforms.json states: nerfstudio moves a point x of
// the world of the original poses to scale (R x + t) in the trained space.
//   top  the keys of the file
// kInput: a key is missing, of a wrong type or out of range; a transform that is no rotation.
Result<Similarity> TrainedFromOriginal(const JsonFields& top);

// Returns the similarity from the space in which nerfstudio trained to the world of the light
// field. The file states the similarity from the world of the original poses to the trained space.
// If the light field is a transforms.json with an applied_transform, its world is the one behind
// that.
//   dataparser   the file dataparser_transforms.json
//   light_field  PathOptions::light_field
Result<Similarity> WorldFromTrained(const std::filesystem::path& dataparser,
                                    const std::filesystem::path& light_field);

// Returns the text of a file: its cameras are those of the path, in the world of the light field
// or, if `space` is "trained", in the trained space, to which the caller has moved them. nerfstudio
// ignores our keys, and takes the middle of the image for the principal point.
std::string NerfstudioText(const CameraPath& path, std::string_view space);

}  // namespace lf
