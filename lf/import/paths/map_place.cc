// SPDX-License-Identifier: Apache-2.0
#include "lf/import/paths/map_place.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string>

#include "lf/pixels/files/geo_tags.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

bool IsTiff(const fs::path& file) {
  std::string extension = file.extension().string();
  for (char& letter : extension)
    letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  return extension == ".tif" || extension == ".tiff";
}

Result<void> CheckUnit(const std::string& file, const GeoTags& tags) {
  constexpr int kMetre = 9001;
  constexpr const char* kRemedy =
      "project the map to metres, such as UTM, or give focus.origin and focus.cell";
  if (tags.is_geographic)
    return InputError(
        fmt::format("{}: the map is in degrees (GTModelTypeGeoKey 2): {}", file, kRemedy));
  if (tags.linear_unit != 0 && tags.linear_unit != kMetre)
    return InputError(
        fmt::format("{}: the map is in units of EPSG code {}, expected 9001, metres: {}", file,
                    tags.linear_unit, kRemedy));
  return {};
}

}  // namespace

Result<void> PlaceMap(const fs::path& folder, double unit_m, FocalSurfaceSource* source) {
  if (source->kind != FocalSurfaceSource::Kind::kHeights) return {};
  const fs::path path = folder / FileOfFrame(*source, 1);
  if (!source->needs_origin && !source->needs_cell && (source->nodata || !IsTiff(path))) return {};
  const std::string file = path.string();
  LF_ASSIGN_OR_RETURN(const GeoTags tags, ReadGeoTags(path));
  if (!source->nodata && tags.nodata && std::isfinite(*tags.nodata)) source->nodata = tags.nodata;
  if (!source->needs_origin && !source->needs_cell) return {};
  const auto missing = [&](const char* key, const char* tag, const char* example) {
    return InputError(fmt::format(
        "focus.{} is missing, and {} has no GeoTIFF tags that state it ({}): give it, such as {}",
        key, file, tag, example));
  };
  if (source->needs_origin && !tags.first_pixel)
    return missing("origin", "ModelTiepointTag and ModelPixelScaleTag", "origin: [0, 0, 0]");
  if (source->needs_cell && !tags.pixel_size)
    return missing("cell", "ModelPixelScaleTag", "cell: 0.5");
  LF_RETURN_IF_ERROR(CheckUnit(file, tags));
  if (source->needs_cell) {
    const auto [across, down] = *tags.pixel_size;
    constexpr double kMostDifference = 1e-6;
    if (std::abs(across - down) > kMostDifference * across)
      return InputError(fmt::format(
          "{}: its pixels measure {:.9g} x {:.9g} m, expected squares: resample the map, or give "
          "focus.cell",
          file, across, down));
    source->right_w *= across / unit_m;
    source->down_w *= down / unit_m;
    source->needs_cell = false;
  }
  if (!source->needs_origin) return {};
  const auto [east, north] = *tags.first_pixel;
  source->origin_w = ((east - source->map_origin_m.x()) * source->right_w.normalized() -
                      (north - source->map_origin_m.y()) * source->down_w.normalized()) /
                     unit_m;
  if (!source->has_scale) source->scale = 1 / unit_m;
  if (!source->has_offset) source->offset_w = -source->map_origin_m.z() / unit_m;
  source->needs_origin = false;
  return {};
}

}  // namespace lf
