// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exports/read_openmvg.h"

#include <fmt/format.h>

#include <map>
#include <string>
#include <utility>

#include "lf/import/exports/export_json.h"
#include "lf/import/exports/import_limits.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr double kMostMvgNumber = 1e9;
constexpr double kMvgCentre_px = 0.5;  // pixel centres of the file are at whole numbers

// Names of the lens models. The file states the name of a model only where it occurs first, with
// its number plus 2^31; further cameras state the number alone.
class MvgModels {
 public:
  Result<std::string> NameOf(const JsonValue& value) {
    constexpr int kNewBit = 31, kMostModels = 1 << 30;
    constexpr double kMostId = 4294967295.0;
    LF_ASSIGN_OR_RETURN(const double stated, value.NumberAt("polymorphic_id", 0, kMostId));
    const auto id = static_cast<uint32_t>(stated);
    const uint32_t number = id & ~(uint32_t{1} << kNewBit);
    if (value.Has("polymorphic_name")) {
      LF_ASSIGN_OR_RETURN(names_[number], value.TextAt("polymorphic_name"));
    }
    const auto found = names_.find(number);
    if (found == names_.end() || number > kMostModels)
      return value.At("polymorphic_id")->Wrong("the number of a lens model that the file names");
    return found->second;
  }

 private:
  std::map<uint32_t, std::string> names_;
};

Result<Distortion> MvgLens(const JsonValue& camera, const std::string& model) {
  const auto numbers = [&](const char* key, size_t count) {
    return camera.NumbersAt(key, count, kMostMvgNumber);
  };
  if (model == "pinhole") return Distortion{};
  if (model == "pinhole_radial_k1") {
    LF_ASSIGN_OR_RETURN(const std::vector<double> p, numbers("disto_k1", 1));
    return DistortionOf(DistortionModel::kRadialTangential, {p[0]});
  }
  if (model == "pinhole_radial_k3") {
    LF_ASSIGN_OR_RETURN(const std::vector<double> p, numbers("disto_k3", 3));
    return DistortionOf(DistortionModel::kRadialTangential, {p[0], p[1], 0, 0, p[2]});
  }
  if (model == "pinhole_brown_t2") {
    LF_ASSIGN_OR_RETURN(const std::vector<double> p, numbers("disto_t2", 5));
    return DistortionOf(DistortionModel::kRadialTangential, {p[0], p[1], p[3], p[4], p[2]});
  }
  if (model == "fisheye") {
    LF_ASSIGN_OR_RETURN(const std::vector<double> p, numbers("fisheye", 4));
    return Distortion{DistortionModel::kFisheye, {p[0], p[1], p[2], p[3]}};
  }
  return camera.Fault(fmt::format(
      "has the lens model \"{}\", which is not supported: expected pinhole, pinhole_radial_k1, "
      "pinhole_radial_k3, pinhole_brown_t2 or fisheye",
      model.substr(0, 80)));
}

Result<Intrinsics> MvgIntrinsics(const JsonValue& value, MvgModels* models) {
  constexpr int kMostSide_px = 65536;
  LF_ASSIGN_OR_RETURN(const std::string model, models->NameOf(value));
  LF_ASSIGN_OR_RETURN(const JsonValue pointer, value.At("ptr_wrapper"));
  LF_ASSIGN_OR_RETURN(const JsonValue camera, pointer.At("data"));
  Intrinsics k;
  LF_ASSIGN_OR_RETURN(k.distortion, MvgLens(camera, model));
  LF_ASSIGN_OR_RETURN(k.width_px, camera.WholeAt("width", 1, kMostSide_px));
  LF_ASSIGN_OR_RETURN(k.height_px, camera.WholeAt("height", 1, kMostSide_px));
  LF_ASSIGN_OR_RETURN(k.fx_px, camera.NumberAt("focal_length", 1e-6, kMostMvgNumber));
  k.fy_px = k.fx_px;
  LF_ASSIGN_OR_RETURN(const std::vector<double> point,
                      camera.NumbersAt("principal_point", 2, kMostMvgNumber));
  k.cx_px = point[0] + kMvgCentre_px;
  k.cy_px = point[1] + kMvgCentre_px;
  return k;
}

Result<RigidTransform> MvgPose(const JsonValue& pose) {
  LF_ASSIGN_OR_RETURN(const JsonValue matrix, pose.At("rotation"));
  LF_ASSIGN_OR_RETURN(const std::vector<double> rows, matrix.Numbers(9, 2));
  const Result<Mat3> rotation = RotationOfRows(rows);
  if (!rotation) return matrix.Fault(rotation.error().message);
  LF_ASSIGN_OR_RETURN(const std::vector<double> centre, pose.NumbersAt("center", 3, kLargest_w));
  return PoseAt(*rotation, Vec3(centre.data()));
}

// Calls `read` with the key and the value of each entry of a list [{"key": K, "value": V}, ...].
template <class Read>
Result<void> ForEachMvgEntry(const JsonValue& top, const char* list, const Read& read) {
  LF_ASSIGN_OR_RETURN(const JsonValue values, top.At(list));
  LF_ASSIGN_OR_RETURN(const std::vector<JsonValue> entries, values.Entries());
  for (const JsonValue& entry : entries) {
    LF_ASSIGN_OR_RETURN(const std::string key, entry.LabelAt("key"));
    LF_ASSIGN_OR_RETURN(const JsonValue value, entry.At("value"));
    LF_RETURN_IF_ERROR(read(key, value));
  }
  return {};
}

}  // namespace

Result<ExportedCameras> ParseOpenMvg(std::string_view text, const fs::path& file) {
  LF_ASSIGN_OR_RETURN(const nlohmann::json tree,
                      ParseExportJson(text, file, {"structure", "control_points"}));
  const JsonValue top(tree, file);
  LF_ASSIGN_OR_RETURN(const std::string version, top.TextAt("sfm_data_version"));
  if (!version.starts_with("0."))
    return top.At("sfm_data_version")->Wrong("a version 0.x, such as \"0.3\"");
  MvgModels models;
  std::map<std::string, Intrinsics> intrinsics;
  std::map<std::string, RigidTransform> poses;
  LF_RETURN_IF_ERROR(ForEachMvgEntry(
      top, "intrinsics", [&](const std::string& key, const JsonValue& value) -> Result<void> {
        LF_ASSIGN_OR_RETURN(intrinsics[key], MvgIntrinsics(value, &models));
        return {};
      }));
  LF_RETURN_IF_ERROR(ForEachMvgEntry(
      top, "extrinsics", [&](const std::string& key, const JsonValue& value) -> Result<void> {
        LF_ASSIGN_OR_RETURN(poses[key], MvgPose(value));
        return {};
      }));
  ExportedCameras exported;
  exported.folder = file.parent_path();
  size_t view_count = 0;
  LF_RETURN_IF_ERROR(ForEachMvgEntry(
      top, "views", [&](const std::string&, const JsonValue& value) -> Result<void> {
        ++view_count;
        LF_ASSIGN_OR_RETURN(const JsonValue pointer, value.At("ptr_wrapper"));
        LF_ASSIGN_OR_RETURN(const JsonValue view, pointer.At("data"));
        LF_ASSIGN_OR_RETURN(const std::string folder, view.TextAt("local_path"));
        LF_ASSIGN_OR_RETURN(const std::string name, view.TextAt("filename"));
        LF_ASSIGN_OR_RETURN(const std::string camera, view.LabelAt("id_intrinsic"));
        LF_ASSIGN_OR_RETURN(const std::string pose, view.LabelAt("id_pose"));
        const auto k = intrinsics.find(camera);
        const auto cam_from_world = poses.find(pose);
        if (k == intrinsics.end() || cam_from_world == poses.end()) return {};
        exported.images.push_back(
            {(fs::path(folder) / name).string(), k->second, cam_from_world->second});
        return {};
      }));
  LogPosedCount(file, exported.images.size(), view_count);
  LF_ASSIGN_OR_RETURN(const std::string root, top.TextAt("root_path"));
  // root_path is where the images were when the scene was made.
  if (!root.empty())
    exported.folder =
        FolderWithImages(exported.images, {FolderAbove(file), root}, FolderAbove(file));
  return exported;
}

Result<LightField> ReadOpenMvg(const fs::path& file, const ExportOptions& options) {
  return ReadExport(file, options, ParseOpenMvg);
}

}  // namespace lf
