// SPDX-License-Identifier: Apache-2.0
// Completes the place of a height map from the GeoTIFF tags of its file.
#pragma once

#include <filesystem>

#include "lf/camera/path/focal_surface_source.h"
#include "lf/core/result.h"

namespace lf {

// Sets the members of a height map that the path does not give from the tags of its file (of the
// first frame, if each frame has a file): origin_w, right_w and down_w, nodata; and scale and
// offset_w if the origin is that of the tags, so that heights are metres above map_origin_m. Given
// values are kept. East is right_w and north -down_w. Does nothing for depths, and reads no file if
// origin and cell are given and the file is no TIFF.
//   folder  of the path, to which the name of the file is relative
//   unit_m  metres per world unit
// kInput: the file has no tags for a value that is not given; its coordinates are degrees, or in
// another unit than metres; its pixels are no squares; or ReadGeoTags().
Result<void> PlaceMap(const std::filesystem::path& folder, double unit_m,
                      FocalSurfaceSource* source);

}  // namespace lf
