// SPDX-License-Identifier: Apache-2.0
// Opens a camera path of any supported form: all programs open their PATH with it.
#pragma once

#include <filesystem>
#include <vector>

#include "lf/camera/path/camera_path.h"
#include "lf/core/result.h"
#include "lf/import/paths/focal_surface_file.h"
#include "lf/import/paths/path_options.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// Returns the options of a path for a light field.
PathOptions PathOptionsFor(const LightField& light_field);

// Returns PathOptionsFor() with Surface::kName, for a path that is rendered or shown. To be focused
// on its surface, it must be given to AddFocalSurfaces().
PathOptions PathOptionsToRender(const LightField& light_field);

// Gives the cameras of a path, which was opened from `path` with Surface::kName, the focal surfaces
// that its file describes, for frames of the light field. Does nothing if it describes none.
// Errors of MakeFocalSurfaces().
Result<void> AddFocalSurfaces(const std::filesystem::path& path, const LightField& light_field,
                              const SurfaceWork& work, CameraPath* opened);

// Returns true if a file is a path in our own YAML, or cannot be read. Errors as for OpenPath().
Result<bool> IsPathYaml(const std::filesystem::path& path);

// Returns the files that a path is read from, which no output may replace: itself and, if it is our
// own YAML, the picture that lens.transmission names, and the pictures that focus.surface names.
std::vector<std::filesystem::path> FilesOfPath(const std::filesystem::path& path);

// Returns the cameras of a path, one for each frame. The form of the file is found by its content:
// - our own YAML: camera/path/path_yaml.h
// - JSON with the key "camera_path": import/paths/nerfstudio_path.h
// - a list of poses by `ns-export cameras` of nerfstudio: import/paths/nerfstudio_poses.h
// - JSON with the key "path": import/paths/ngp_path.h
// - lines of numbers, a .chan of Nuke: import/paths/chan_path.h
// - a transforms.json, the folder of one or of a COLMAP model, or a cameras.json of 3D Gaussian
//   splatting, whose cameras become the frames: import/paths/frames_path.h. A file of a COLMAP
//   model, such as images.txt, stands for its folder
// doc/formats/foreign_paths.md lists the conventions. A warning lists each quantity that the file
// does not state, and the value that is used.
//
// kInput: the file cannot be read, or an error of the reader; a camera type other than perspective;
// another unit_m than the light field's; a focal surface (PathOptions::surface,
// MakeFocalSurfaces()). kUsage: an option that the form of the file does not
// allow.
Result<CameraPath> OpenPath(const std::filesystem::path& path, const PathOptions& options);

}  // namespace lf
