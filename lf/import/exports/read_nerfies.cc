// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exports/read_nerfies.h"

#include <fmt/format.h>

#include <optional>
#include <set>
#include <string>
#include <system_error>
#include <utility>

#include "lf/core/file.h"
#include "lf/import/exports/export_files.h"
#include "lf/import/exports/export_json.h"
#include "lf/import/exports/import_limits.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr double kMostNerfiesNumber = 1e9;

Result<Distortion> NerfiesLens(const JsonValue& camera) {
  LF_ASSIGN_OR_RETURN(const std::vector<double> k,
                      camera.NumbersAt("radial_distortion", 3, kMostNerfiesNumber));
  // Older files have the key "tangential".
  LF_ASSIGN_OR_RETURN(
      const std::vector<double> p,
      camera.NumbersAt(camera.Has("tangential") ? "tangential" : "tangential_distortion", 2,
                       kMostNerfiesNumber));
  return DistortionOf(DistortionModel::kRadialTangential, {k[0], k[1], p[0], p[1], k[2]});
}

// Returns the ids that dataset.json lists; none if the file or its list is not there.
Result<std::optional<std::set<std::string>>> NerfiesIds(const fs::path& file) {
  std::error_code error;
  if (!fs::exists(file, error)) return std::optional<std::set<std::string>>();
  LF_ASSIGN_OR_RETURN(const std::string text, ReadFile(file, kMostExportBytes));
  LF_ASSIGN_OR_RETURN(const nlohmann::json tree, ParseExportJson(text, file));
  const JsonValue top(tree, file);
  if (!top.Has("ids")) return std::optional<std::set<std::string>>();
  LF_ASSIGN_OR_RETURN(const JsonValue list, top.At("ids"));
  LF_ASSIGN_OR_RETURN(const std::vector<JsonValue> entries, list.Entries());
  std::optional<std::set<std::string>> ids(std::in_place);
  for (const JsonValue& entry : entries) {
    LF_ASSIGN_OR_RETURN(std::string id, entry.Label());
    ids->insert(std::move(id));
  }
  return ids;
}

// Returns the depth range of scene.json, in world units.
Result<std::optional<DepthRange>> NerfiesDepths(const fs::path& file) {
  std::error_code error;
  if (!fs::exists(file, error)) return std::optional<DepthRange>();
  LF_ASSIGN_OR_RETURN(const std::string text, ReadFile(file, kMostExportBytes));
  LF_ASSIGN_OR_RETURN(const nlohmann::json tree, ParseExportJson(text, file));
  const JsonValue top(tree, file);
  if (!top.Has("near") || !top.Has("far")) return std::optional<DepthRange>();
  LF_ASSIGN_OR_RETURN(const double scale, top.NumberOr("scale", 1, 1e-9, kMostNerfiesNumber));
  LF_ASSIGN_OR_RETURN(const double near_scaled, top.NumberAt("near", 0, kMostNerfiesNumber));
  LF_ASSIGN_OR_RETURN(const double far_scaled, top.NumberAt("far", 0, kMostNerfiesNumber));
  if (!(near_scaled > 0 && near_scaled < far_scaled)) return std::optional<DepthRange>();
  return std::optional(DepthRange{near_scaled / scale, far_scaled / scale});
}

}  // namespace

Result<ExportedImage> ParseNerfiesCamera(std::string_view text, const fs::path& file) {
  constexpr int kMostSide_px = 65536;
  LF_ASSIGN_OR_RETURN(const nlohmann::json tree, ParseExportJson(text, file));
  const JsonValue camera(tree, file);
  ExportedImage image;
  image.name = file.stem().string() + ".png";
  Intrinsics& k = image.intrinsics;
  LF_ASSIGN_OR_RETURN(const JsonValue size, camera.At("image_size"));
  LF_ASSIGN_OR_RETURN(const std::vector<JsonValue> sides, size.Entries());
  if (sides.size() != 2) return size.Wrong("the width and the height");
  LF_ASSIGN_OR_RETURN(k.width_px, sides[0].Whole(1, kMostSide_px));
  LF_ASSIGN_OR_RETURN(k.height_px, sides[1].Whole(1, kMostSide_px));
  LF_ASSIGN_OR_RETURN(k.fx_px, camera.NumberAt("focal_length", 1e-6, kMostNerfiesNumber));
  LF_ASSIGN_OR_RETURN(const double ratio,
                      camera.NumberOr("pixel_aspect_ratio", 1, 1e-6, kMostNerfiesNumber));
  k.fy_px = k.fx_px * ratio;
  LF_ASSIGN_OR_RETURN(k.skew_px,
                      camera.NumberOr("skew", 0, -kMostNerfiesNumber, kMostNerfiesNumber));
  LF_ASSIGN_OR_RETURN(const std::vector<double> point,
                      camera.NumbersAt("principal_point", 2, kMostNerfiesNumber));
  k.cx_px = point[0];
  k.cy_px = point[1];
  LF_ASSIGN_OR_RETURN(k.distortion, NerfiesLens(camera));
  LF_ASSIGN_OR_RETURN(const JsonValue matrix, camera.At("orientation"));
  LF_ASSIGN_OR_RETURN(const std::vector<double> rows, matrix.Numbers(9, 2));
  const Result<Mat3> rotation = RotationOfRows(rows);
  if (!rotation) return matrix.Fault(rotation.error().message);
  LF_ASSIGN_OR_RETURN(const std::vector<double> centre,
                      camera.NumbersAt("position", 3, kLargest_w));
  image.cam_from_world = PoseAt(*rotation, Vec3(centre.data()));
  return image;
}

Result<LightField> ReadNerfies(const fs::path& file, const ExportOptions& options) {
  const fs::path folder = FolderAbove(fs::absolute(file)), root = FolderAbove(folder);
  LF_ASSIGN_OR_RETURN(const auto ids, NerfiesIds(root / "dataset.json"));
  LF_ASSIGN_OR_RETURN(const std::vector<fs::path> files, SortedFilesIn(folder, ".json"));
  ExportedCameras exported;
  for (const fs::path& camera : files) {
    if (ids && ids->find(camera.stem().string()) == ids->end()) continue;
    LF_ASSIGN_OR_RETURN(const std::string text, ReadFile(camera, kMostExportBytes));
    LF_ASSIGN_OR_RETURN(ExportedImage image, ParseNerfiesCamera(text, camera));
    exported.images.push_back(std::move(image));
  }
  LF_ASSIGN_OR_RETURN(exported.depth_range, NerfiesDepths(root / "scene.json"));
  const fs::path rgb = root / "rgb";
  exported.folder = FolderWithImages(
      exported.images, {rgb / "1x", rgb / "2x", rgb / "4x", rgb / "8x", rgb / "16x"}, root);
  return FinishExport(std::move(exported), folder, options);
}

}  // namespace lf
