// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exports/read_google_models.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "lf/import/exports/export_json.h"
#include "lf/import/exports/import_limits.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr double kMostGoogleNumber = 1e9;

Result<Distortion> GoogleLens(const JsonValue& camera) {
  std::string projection = "perspective";
  if (camera.Has("projection_type")) {
    LF_ASSIGN_OR_RETURN(projection, camera.TextAt("projection_type"));
  }
  std::vector<double> k = {0, 0, 0};
  if (camera.Has("radial_distortion")) {
    LF_ASSIGN_OR_RETURN(const JsonValue list, camera.At("radial_distortion"));
    LF_ASSIGN_OR_RETURN(const std::vector<JsonValue> entries, list.Entries());
    if (entries.size() > k.size()) return list.Wrong("at most 3 numbers");
    LF_ASSIGN_OR_RETURN(const std::vector<double> numbers,
                        list.Numbers(entries.size(), kMostGoogleNumber));
    std::copy(numbers.begin(), numbers.end(), k.begin());
    if (k[2] != 0)
      return list.Wrong("0 as third number, because the meaning of another one is not documented");
    if (projection != "fisheye" && (k[0] != 0 || k[1] != 0))
      return list.Wrong(
          "zeros, because the distortion of lenses other than fish-eyes is not documented");
  }
  if (projection == "fisheye") return Distortion{DistortionModel::kFisheye, {k[0], k[1]}};
  return Distortion{};
}

Result<Intrinsics> GoogleIntrinsics(const JsonValue& camera) {
  constexpr int kMostSide_px = 65536;
  Intrinsics k;
  LF_ASSIGN_OR_RETURN(k.width_px, camera.WholeAt("width", 1, kMostSide_px));
  LF_ASSIGN_OR_RETURN(k.height_px, camera.WholeAt("height", 1, kMostSide_px));
  LF_ASSIGN_OR_RETURN(k.fx_px, camera.NumberAt("focal_length", 1e-6, kMostGoogleNumber));
  LF_ASSIGN_OR_RETURN(const double ratio,
                      camera.NumberOr("pixel_aspect_ratio", 1, 1e-6, kMostGoogleNumber));
  k.fy_px = k.fx_px * ratio;
  LF_ASSIGN_OR_RETURN(const std::vector<double> point,
                      camera.NumbersAt("principal_point", 2, kMostGoogleNumber));
  k.cx_px = point[0];
  k.cy_px = point[1];
  LF_ASSIGN_OR_RETURN(k.distortion, GoogleLens(camera));
  return k;
}

Result<ExportedImage> GoogleImage(const JsonValue& camera) {
  ExportedImage image;
  LF_ASSIGN_OR_RETURN(image.name,
                      camera.TextAt(camera.Has("relative_path") ? "relative_path" : "name"));
  LF_ASSIGN_OR_RETURN(image.intrinsics, GoogleIntrinsics(camera));
  LF_ASSIGN_OR_RETURN(const JsonValue orientation, camera.At("orientation"));
  LF_ASSIGN_OR_RETURN(const std::vector<double> axis, orientation.Numbers(3, 1e3));
  const Result<Mat3> rotation = RotationOfAxisAngle({axis[0], axis[1], axis[2]});
  if (!rotation) return orientation.Fault(rotation.error().message);
  LF_ASSIGN_OR_RETURN(const std::vector<double> centre,
                      camera.NumbersAt("position", 3, kLargest_w));
  image.cam_from_world = PoseAt(*rotation, {centre[0], centre[1], centre[2]});
  return image;
}

}  // namespace

Result<ExportedCameras> ParseGoogleModels(std::string_view text, const fs::path& file) {
  LF_ASSIGN_OR_RETURN(const nlohmann::json tree, ParseExportJson(text, file));
  LF_ASSIGN_OR_RETURN(const std::vector<JsonValue> entries, JsonValue(tree, file).Entries());
  ExportedCameras cameras;
  cameras.folder = FolderAbove(file);
  for (const JsonValue& entry : entries) {
    std::vector<JsonValue> of_place = {entry};
    if (Result<std::vector<JsonValue>> list = entry.Entries(); list) of_place = *std::move(list);
    for (const JsonValue& camera : of_place) {
      LF_ASSIGN_OR_RETURN(ExportedImage image, GoogleImage(camera));
      cameras.images.push_back(std::move(image));
    }
  }
  return cameras;
}

Result<LightField> ReadGoogleModels(const fs::path& file, const ExportOptions& options) {
  return ReadExport(file, options, ParseGoogleModels);
}

}  // namespace lf
