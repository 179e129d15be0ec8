// SPDX-License-Identifier: Apache-2.0
// Interprets the attributes of an HDF5 file of the first light field benchmark of the HCI, which
// state the geometry of its cameras (doc/formats/pictures_of_views.md, "HDF5"; Wanner, Meister,
// Goldlücke 2013). Internal to this folder.
#pragma once

#include <optional>
#include <string>

#include "lf/core/geometry.h"
#include "lf/core/result.h"
#include "lf/pixels/files/hdf5_array.h"
#include "lf/pixels/files/view_array.h"

namespace lf {

inline constexpr const char* kHciArchiveName = "lf.h5";  // beside labels.h5 in the archive

// Unset: the file does not state the value.
struct HciArchive {
  // Distance from one column (x, dH), and from one row (y, dV; without it dH), to the next, in the
  // unit of the file.
  std::optional<Vec2> pitch_w = {};
  // focalLength, if it can be a number of pixels.
  std::optional<double> focal_px = {};
  // Depth of the plane that stands still in all views, in the unit of dH. The disparity of a point
  // at depth Z is, in pixels,
  //   d = dH focalLength / Z - shift
  // and 0 at this depth. Unset also if shift is 0.
  std::optional<double> plane_distance_w = {};
  // focalLength, if it cannot be a number of pixels: of files whose unit is another one.
  std::optional<double> unclear_focal_length = {};
};

// Returns what the attributes state. kInput: an attribute is not finite, or outside the range in
// which StanfordOptions takes it; sizes that differ from those of the array.
//   name  of the file, for messages
Result<HciArchive> HciArchiveOf(const Hdf5Attributes& attributes, const ViewArray& array,
                                const std::string& name);

}  // namespace lf
