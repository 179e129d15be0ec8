// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exports/read_record3d.h"

#include <fmt/format.h>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "lf/core/file.h"
#include "lf/core/parse_number.h"
#include "lf/import/exports/export_json.h"
#include "lf/import/exports/import_limits.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr double kMostRecord3dNumber = 1e9;

Result<Intrinsics> Record3dIntrinsics(const JsonValue& top) {
  constexpr int kMostSide_px = 65536;
  LF_ASSIGN_OR_RETURN(const int width_px, top.WholeAt("w", 1, kMostSide_px));
  LF_ASSIGN_OR_RETURN(const int height_px, top.WholeAt("h", 1, kMostSide_px));
  LF_ASSIGN_OR_RETURN(const JsonValue matrix, top.At("K"));
  LF_ASSIGN_OR_RETURN(const std::vector<double> m, matrix.Numbers(9, kMostRecord3dNumber));
  std::optional<Intrinsics> k =
      IntrinsicsOfRows({m[0], m[3], m[6], m[1], m[4], m[7], m[2], m[5], m[8]});
  if (!k) return matrix.Wrong("a calibration matrix, column by column: fx 0 0 skew fy 0 cx cy 1");
  k->width_px = width_px;
  k->height_px = height_px;
  return *k;
}

// Reads qx qy qz qw x y z.
Result<RigidTransform> Record3dPose(const JsonValue& pose) {
  LF_ASSIGN_OR_RETURN(const std::vector<double> p, pose.Numbers(7, kLargest_w));
  const Result<Mat3> world_from_opengl = RotationOfQuaternion(p[3], p[0], p[1], p[2]);
  if (!world_from_opengl) return pose.Fault(world_from_opengl.error().message);
  return PoseAt(CameraFromOpenGl() * world_from_opengl->transpose(), {p[4], p[5], p[6]});
}

// Returns the intrinsics of each image; empty if all have those of K.
Result<std::vector<JsonValue>> IntrinsicsOfFrames(const JsonValue& top, size_t count) {
  constexpr const char* kKey = "perFrameIntrinsicCoeffs";
  if (!top.Has(kKey)) return std::vector<JsonValue>();
  LF_ASSIGN_OR_RETURN(const JsonValue list, top.At(kKey));
  LF_ASSIGN_OR_RETURN(std::vector<JsonValue> entries, list.Entries());
  if (!entries.empty() && entries.size() != count)
    return list.Fault(fmt::format("has {} entries, but there are {} poses: expected one for each",
                                  entries.size(), count));
  return entries;
}

// Returns those image files of a folder whose names are whole numbers, by their numbers.
std::map<uint32_t, std::string> NumberedImages(const fs::path& folder) {
  std::map<uint32_t, std::string> names;
  const Result<std::vector<std::string>> all = SortedImageNames(folder);
  if (!all) return names;
  for (const std::string& name : *all)
    if (const auto number = ParseWhole<uint32_t>(fs::path(name).stem().string()))
      names.emplace(*number, name);
  return names;
}

// Names the images after the files that there are. Keeps the names if no folder has them.
void NameByFiles(ExportedCameras* cameras) {
  const size_t count = cameras->images.size();
  for (const char* const folder : {"rgbd", "rgb", "images", ""}) {
    const std::map<uint32_t, std::string> names = NumberedImages(cameras->folder / folder);
    if (names.empty()) continue;
    const bool are_indices = names.rbegin()->first < count;
    if (!are_indices && names.size() != count) continue;
    size_t i = 0;
    for (const auto& [number, name] : names)
      cameras->images[are_indices ? number : i++].name = (fs::path(folder) / name).string();
    return;
  }
}

}  // namespace

Result<ExportedCameras> ParseRecord3d(std::string_view text, const fs::path& file) {
  LF_ASSIGN_OR_RETURN(const nlohmann::json tree, ParseExportJson(text, file, {"frameTimestamps"}));
  const JsonValue top(tree, file);
  LF_ASSIGN_OR_RETURN(const Intrinsics of_all, Record3dIntrinsics(top));
  LF_ASSIGN_OR_RETURN(const JsonValue list, top.At("poses"));
  LF_ASSIGN_OR_RETURN(const std::vector<JsonValue> poses, list.Entries());
  LF_ASSIGN_OR_RETURN(const std::vector<JsonValue> lenses, IntrinsicsOfFrames(top, poses.size()));
  ExportedCameras cameras;
  cameras.folder = FolderAbove(file);
  for (size_t i = 0; i < poses.size(); ++i) {
    ExportedImage image;
    image.name = fmt::format("rgbd/{}.jpg", i);
    image.intrinsics = of_all;
    if (!lenses.empty()) {
      LF_ASSIGN_OR_RETURN(const std::vector<double> k, lenses[i].Numbers(4, kMostRecord3dNumber));
      image.intrinsics.fx_px = k[0];
      image.intrinsics.fy_px = k[1];
      image.intrinsics.cx_px = k[2];
      image.intrinsics.cy_px = k[3];
      image.intrinsics.skew_px = 0;
    }
    LF_ASSIGN_OR_RETURN(image.cam_from_world, Record3dPose(poses[i]));
    cameras.images.push_back(std::move(image));
  }
  return cameras;
}

Result<LightField> ReadRecord3d(const fs::path& file, const ExportOptions& options) {
  LF_ASSIGN_OR_RETURN(const std::string text, ReadFile(file, kMostExportBytes));
  LF_ASSIGN_OR_RETURN(ExportedCameras cameras, ParseRecord3d(text, file));
  NameByFiles(&cameras);
  return FinishExport(std::move(cameras), file, options);
}

}  // namespace lf
