// SPDX-License-Identifier: Apache-2.0
// Definitions that the writer and the reader of package files share. Internal to this folder.
#pragma once

#include <span>
#include <vector>

#include "lf/camera/render_camera.h"
#include "lf/storage/sqlite/database.h"

namespace lf {

inline constexpr DatabaseFormat kPackageFormat = {"package", 0x4C465047 /* "LFPG" */, 3, 4096};

// Tables of a package besides settings and intrinsics (doc/formats/package.md).
inline constexpr const char* kPackageTables = R"(
create table lf_images (rank integer primary key, id integer, name text, mask text,
  intrinsics integer, gain real, x real, y real, z real, pose blob, file_bytes integer,
  x_begin integer, y_begin integer, x_end integer, y_end integer, frames integer, rays integer);
create table frames (frame integer primary key, time_s real, x real, y real, z real,
  aperture_diameter real, focus_distance real, camera blob, is_rendered integer,
  lf_images integer, rays integer, camera_distance real, surroundings blob);
)";

// Further table of a package with virtual LF images: their numbers in the whole light field.
inline constexpr const char* kVirtualTable =
    "create table virtual_images (id integer primary key);";

// Further table of a package whose path has a shutter: the cameras of all instants of the film, as
// the cameras of frames, and the distance between LF cameras around their lenses.
inline constexpr const char* kInstantsTable =
    "create table instants (frame integer, instant integer, time_s real, camera blob, "
    "camera_distance real);";

// Further table of a package whose path has focal surfaces: FocalSurface::Bytes() of each camera,
// first of all frames (instant 0), then of all instants.
inline constexpr const char* kSurfacesTable =
    "create table focal_surfaces (frame integer, instant integer, pieces blob);";

// Number of values that describe a frame's camera exactly, unless HasShape(camera): fx, fy,
// cx, cy, skew, width, height; pose; radius, blades and rotation of the aperture; normal and offset
// of the focus plane; time, focal length, sensor width, focus distance, horizontal and vertical
// tilt, unit_m.
inline constexpr size_t kCameraNumbers = 33;
// Number of values that follow if HasShape(camera): ratio and roundness of the aperture, distance
// and radius of the hood.
inline constexpr size_t kShapeNumbers = 4;
std::vector<double> NumbersOfCamera(const RenderCamera& camera);
//   numbers  kCameraNumbers of them, or kCameraNumbers + kShapeNumbers
RenderCamera CameraOfNumbers(std::span<const double> numbers);

// Number of values that describe a FrameSurroundings, in the order of its members, of which
// middle_world has three values. One more if recorded_distance_w is set.
inline constexpr size_t kSurroundingsNumbers = 6;

}  // namespace lf
