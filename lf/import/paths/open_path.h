// SPDX-License-Identifier: Apache-2.0
// Opens a camera path of any supported form: all programs open their PATH with it.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "lf/camera/path/camera_path.h"
#include "lf/core/geometry.h"
#include "lf/core/result.h"
#include "lf/import/paths/focal_surface_file.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// Order in which the rotations about the axes of a .chan file are applied: with kZxy, first about
// z, then about x, then about y.
enum class RotationOrder { kXyz, kXzy, kYxz, kYzx, kZxy, kZyx };

// Returns the order of a name such as "zxy"; nullopt if the name is unknown.
std::optional<RotationOrder> RotationOrderOf(std::string_view name);

// Values for which the file of the path has no place, or that replace those of the file.
struct PathOptions {
  // The three members below describe the light field that the path is for; PathOptionsFor() sets
  // them. Without a light field, they are empty.
  std::optional<double> light_field_unit_m = {};  // as for ReadPathYaml()
  std::optional<DepthRange> depth_range = {};     // depths of the scene: where to focus by default
  // If it has a transforms.json, this file states the light field's world and instant-ngp's space.
  std::filesystem::path light_field = {};

  // Use of the focal surface that the path may have (CameraPath::focal_surface).
  //   kRefuse  it is an error, because the program knows focus planes only
  //   kName    the path names it, but the cameras have none: to show or convert a path, or to
  //            choose frames before AddFocalSurfaces()
  //   kMake    all cameras get it (MakeFocalSurfaces()), by one thread
  enum class Surface { kRefuse, kName, kMake };
  Surface surface = Surface::kRefuse;
  double camera_distance_w = 0;  // for kMake: NearestCameraDistance() of the light field

  // The members below replace what the file states.
  // Width and height; the field of view of the width is kept. 1920 x 1080 if nothing is stated.
  std::optional<std::array<int, 2>> resolution_px = {};
  std::optional<double> sensor_width_mm = {};       // the field of view is kept; 36 by default
  std::optional<double> f_number = {};              // at most one of f_number and the diameter
  std::optional<double> aperture_diameter_mm = {};  // 0, a pinhole, by default
  std::optional<double> focus_distance_w = {};

  // The members below are used by the formats that do not state the quantity.
  std::optional<double> fps = {};  // 30 by default
  // Frames of an instant-ngp curve; by default fps times the duration.
  std::optional<uint32_t> frame_count = {};
  std::optional<double> focal_length_mm = {};  // gives the field of view; 50 by default
  RotationOrder rotation_order = RotationOrder::kZxy;
  // The dataparser_transforms.json of nerfstudio; by default the one beside the path.
  std::filesystem::path dataparser_transforms = {};
  // Scale and offset of instant-ngp's space; by default those of the light field's transforms.json,
  // of the transforms.json beside the path, or 0.33 and 0.5.
  std::optional<double> ngp_scale = {};
  std::optional<Vec3> ngp_offset = {};
};

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
// - JSON with the key "path": import/paths/ngp_path.h
// - lines of numbers, a .chan of Nuke: import/paths/chan_path.h
// - a transforms.json, the folder of one or of a COLMAP model, or a cameras.json of 3D Gaussian
//   splatting, whose cameras become the frames: import/paths/frames_path.h
// doc/formats/foreign_paths.md lists the conventions. A warning lists each quantity that the file
// does not state, and the value that is used.
//
// kInput: the file cannot be read, or an error of the reader; a camera type other than perspective;
// another unit_m than the light field's; a focal surface (PathOptions::surface,
// MakeFocalSurfaces()). kUsage: an option that the form of the file does not
// allow.
Result<CameraPath> OpenPath(const std::filesystem::path& path, const PathOptions& options);

}  // namespace lf
