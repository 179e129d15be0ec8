// SPDX-License-Identifier: Apache-2.0
// The tags of a TIFF file that place its picture in a map: GeoTIFF (OGC 19-008) and GDAL's value of
// unknown places.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "lf/core/result.h"

namespace lf {

struct GeoTags {
  // Map coordinates x (east) and y (north) of the middle of the uppermost left pixel, from
  // ModelTiepointTag (33922) and ModelPixelScaleTag (33550) or ModelTransformationTag (34264), by
  // GTRasterTypeGeoKey (1025): coordinates are those of a pixel's corner unless it states points.
  std::optional<std::array<double, 2>> first_pixel;
  // Distances from one pixel to the next, to the right (east) and down (south). Above 0.
  std::optional<std::array<double, 2>> pixel_size;
  bool is_geographic = false;  // coordinates are degrees (GTModelTypeGeoKey, 1024)
  // EPSG code of the unit of projected coordinates (ProjLinearUnitsGeoKey, 3076); 9001 is the
  // metre; 0: not stated.
  int linear_unit = 0;
  std::optional<double> nodata;  // GDAL_NODATA (42113); NaN is possible
};

// Reads the tags of the first picture. A file that is no TIFF, or has none of them, states nothing.
// kInput: the file cannot be read or is damaged; a tag has another type or number of values than
// the standard says; the picture is turned or sheared against the axes of the map, or mirrored; or
// it is placed by several tie points without a scale.
Result<GeoTags> ReadGeoTags(const std::filesystem::path& path);

// Reads the tags of a file that is in memory; messages call the file `name`.
Result<GeoTags> ReadGeoTagsBytes(std::string_view bytes, const std::string& name);

}  // namespace lf
