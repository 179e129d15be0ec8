// SPDX-License-Identifier: Apache-2.0
// The picture that the focal surface of a path is made of: a depth picture or a height map
// (doc/formats/path.md, "The focal surface").
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "lf/core/geometry.h"

namespace lf {

struct FocalSurfaceSource {
  enum class Kind {
    kDepths,   // depths along the optical axis, seen from the camera of each frame
    kHeights,  // heights of a map in the world
  };

  // Name of the picture file, relative to the folder of the path. If it has a %d, such as %04d, the
  // number of the frame takes its place.
  std::string file;
  Kind kind = Kind::kDepths;
  double scale = 1;  // depth or height in world units = scale * value (+ offset_w)
  // The blur, in elements, beyond which a piece of the surface is divided (SurfaceFitOptions).
  double most_blur_px = 0.5;
  std::optional<double> nodata;  // the value in the file of a place that is unknown

  // The members below are those of height maps. The sample in column c and row r (from 0) is at
  //   origin_w + c right_w + r down_w + (scale * value + offset_w) up.
  double offset_w = 0;
  Vec3 origin_w = Vec3::Zero();
  Vec3 right_w = Vec3::UnitX();  // from one column to the next
  Vec3 down_w = -Vec3::UnitY();  // from one row to the next
  Vec3 up = Vec3::UnitZ();       // of length 1

  // True: the value is not given, and still has to be read from the GeoTIFF tags of the file
  // (import/paths/map_place.h). right_w and down_w have length 1 until then.
  bool needs_origin = false;
  bool needs_cell = false;
  bool has_scale = false;   // true: scale is given, false: it may follow from the unit of the map
  bool has_offset = false;  // true: offset_w is given
  // Map coordinates of the origin of the world, east, north and height in metres, which are
  // subtracted from those of the tags.
  Vec3 map_origin_m = Vec3::Zero();

  friend bool operator==(const FocalSurfaceSource&, const FocalSurfaceSource&) = default;
};

// Returns the name of the file for a frame.
std::string FileOfFrame(const FocalSurfaceSource& source, uint32_t frame);
// Returns true if each frame has a file of its own.
bool HasFilePerFrame(const FocalSurfaceSource& source);

}  // namespace lf
