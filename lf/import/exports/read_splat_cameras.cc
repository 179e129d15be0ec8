// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exports/read_splat_cameras.h"

#include <string>
#include <utility>

#include "lf/import/exports/export_json.h"
#include "lf/import/exports/import_limits.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

Result<ExportedImage> SplatImage(const JsonValue& camera) {
  constexpr int kMostSide_px = 65536;
  constexpr double kMostFocal_px = 1e9;
  ExportedImage image;
  LF_ASSIGN_OR_RETURN(image.name, camera.LabelAt("img_name"));
  Intrinsics& k = image.intrinsics;
  LF_ASSIGN_OR_RETURN(k.width_px, camera.WholeAt("width", 1, kMostSide_px));
  LF_ASSIGN_OR_RETURN(k.height_px, camera.WholeAt("height", 1, kMostSide_px));
  LF_ASSIGN_OR_RETURN(k.fx_px, camera.NumberAt("fx", 0, kMostFocal_px));
  LF_ASSIGN_OR_RETURN(k.fy_px, camera.NumberAt("fy", 0, kMostFocal_px));
  k.cx_px = 0.5 * k.width_px;
  k.cy_px = 0.5 * k.height_px;
  LF_ASSIGN_OR_RETURN(const JsonValue matrix, camera.At("rotation"));
  LF_ASSIGN_OR_RETURN(const std::vector<double> rows, matrix.Numbers(9, 2));
  const Result<Mat3> world_from_cam = RotationOfRows(rows);
  if (!world_from_cam) return matrix.Fault(world_from_cam.error().message);
  LF_ASSIGN_OR_RETURN(const std::vector<double> centre,
                      camera.NumbersAt("position", 3, kLargest_w));
  image.cam_from_world = PoseAt(world_from_cam->transpose(), Vec3(centre.data()));
  return image;
}

}  // namespace

Result<ExportedCameras> ParseSplatLightField(std::string_view text, const fs::path& file) {
  LF_ASSIGN_OR_RETURN(const nlohmann::json tree, ParseExportJson(text, file));
  const JsonValue top(tree, file);
  LF_ASSIGN_OR_RETURN(const std::vector<JsonValue> entries, top.Entries());
  ExportedCameras exported;
  for (const JsonValue& entry : entries) {
    LF_ASSIGN_OR_RETURN(ExportedImage image, SplatImage(entry));
    exported.images.push_back(std::move(image));
  }
  exported.folder = file.parent_path();
  return exported;
}

Result<LightField> ReadSplatLightField(const fs::path& file, const ExportOptions& options) {
  return ReadExport(file, options, ParseSplatLightField);
}

}  // namespace lf
