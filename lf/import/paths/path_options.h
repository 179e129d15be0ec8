// SPDX-License-Identifier: Apache-2.0
// Options of a camera path, besides its file (doc/formats/foreign_paths.md).
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>

#include "lf/core/geometry.h"

namespace lf {

// Order in which the rotations about the axes of a .chan file are applied: with kZxy, first about
// z, then about x, then about y.
enum class RotationOrder { kXyz, kXzy, kYxz, kYzx, kZxy, kZyx };

// Returns the order of a name such as "zxy"; nullopt if the name is unknown.
std::optional<RotationOrder> RotationOrderOf(std::string_view name);

// Unit of the vertical field of view that a file states.
enum class FovUnit { kDegrees, kRadians };

// Returns the unit of a name, "degrees" or "radians"; nullopt if the name is unknown.
std::optional<FovUnit> FovUnitOf(std::string_view name);

// Values for which the file of the path has no place, or that replace those of the file.
struct PathOptions {
  // The three members below describe the light field that the path is for. OpenFilm() and
  // PathOptionsFor() set them. Without a light field, they are empty.
  std::optional<double> light_field_unit_m =
      {};  // metres per world unit; a path of another is refused
  std::optional<DepthRange> depth_range = {};  // depths of the scene: where to focus by default
  // If it has a transforms.json, this file states the light field's world and instant-ngp's space.
  std::filesystem::path light_field = {};

  // Use of the focal surface that the path may have (CameraPath::focal_surface). OpenFilm() sets
  // it, and gives the surface to all cameras.
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
  // For paths of nerfstudio, instant-ngp and Nuke, whose fields of view are in degrees. If it is
  // not set, a file with fields of view that may be radians as well is refused.
  std::optional<FovUnit> fov_unit = {};
  // The dataparser_transforms.json of nerfstudio; by default the one beside the path.
  std::filesystem::path dataparser_transforms = {};
  // Scale and offset of instant-ngp's space; by default those of the light field's transforms.json,
  // of the transforms.json beside the path, or 0.33 and 0.5.
  std::optional<double> ngp_scale = {};
  std::optional<Vec3> ngp_offset = {};
};

}  // namespace lf
