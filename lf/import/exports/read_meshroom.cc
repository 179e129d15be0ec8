// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exports/read_meshroom.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <utility>

#include "lf/import/exports/export_json.h"
#include "lf/import/exports/import_limits.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr double kMostMeshroomNumber = 1e9;
constexpr double kWholeCentre_px = 0.5;  // pixel centres of the file are at whole numbers
constexpr const char* kNoMeshroomLens = "none";

using MeshroomVersion = std::array<int, 3>;

// Returns the entries of a list. An empty list is written as an empty text.
Result<std::vector<JsonValue>> MeshroomList(const JsonValue& object, const char* key) {
  if (!object.Has(key)) return std::vector<JsonValue>();
  LF_ASSIGN_OR_RETURN(const JsonValue list, object.At(key));
  if (const Result<std::string> text = list.Text(); text && text->empty())
    return std::vector<JsonValue>();
  return list.Entries();
}

Result<MeshroomVersion> MeshroomVersionOf(const JsonValue& top) {
  LF_ASSIGN_OR_RETURN(const JsonValue value, top.At("version"));
  LF_ASSIGN_OR_RETURN(const std::vector<double> numbers, value.Numbers(3, kMostMeshroomNumber));
  if (numbers[0] != 1)
    return value.Wrong(
        "version 1.x of AliceVision's scenes, or the scene as COLMAP (Meshroom's "
        "node ExportColmap)");
  MeshroomVersion version;
  std::transform(numbers.begin(), numbers.end(), version.begin(),
                 [](double number) { return static_cast<int>(number); });
  return version;
}

std::string MeshroomLowerCase(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  return text;
}

// Returns the name of the distortion, as scenes since version 1.2.8 write it.
Result<std::string> MeshroomDistortionName(const JsonValue& camera,
                                           const MeshroomVersion& version) {
  LF_ASSIGN_OR_RETURN(std::string type, camera.TextAt("type"));
  type = MeshroomLowerCase(type);
  const auto unsupported = [&](const std::string& model) {
    return camera.Fault(fmt::format(
        "has the lens model \"{}\", which is not supported: expected pinhole without distortion or "
        "with radial1, radial3, brown, fisheye4 or fisheye1",
        model.substr(0, 80)));
  };
  if (version < MeshroomVersion{1, 2, 8}) {
    const std::map<std::string, std::string> names = {
        {"pinhole", kNoMeshroomLens}, {"radial1", "radialk1"}, {"radial3", "radialk3"},
        {"brown", "brown"},           {"fisheye4", "fisheye"}, {"fisheye1", "fisheye1"}};
    const auto found = names.find(type);
    if (found == names.end()) return unsupported(type);
    return found->second;
  }
  if (type != "pinhole") return unsupported(type);
  if (camera.Has("undistortionType")) {
    LF_ASSIGN_OR_RETURN(const std::string name, camera.TextAt("undistortionType"));
    if (MeshroomLowerCase(name) != kNoMeshroomLens) return unsupported(name);
  }
  LF_ASSIGN_OR_RETURN(const std::string name, camera.TextAt("distortionType"));
  const std::string known[] = {kNoMeshroomLens, "radialk1", "radialk3", "radialk3pt",
                               "brown",         "fisheye",  "fisheye1"};
  if (std::find(std::begin(known), std::end(known), MeshroomLowerCase(name)) == std::end(known))
    return unsupported(name);
  return MeshroomLowerCase(name);
}

// Sets the distortion. The model radialk3pt is radialk3, divided by its value at r = 1, which is a
// factor of the focal length.
Result<void> ReadMeshroomLens(const JsonValue& camera, const MeshroomVersion& version,
                              Intrinsics* k) {
  LF_ASSIGN_OR_RETURN(const std::string name, MeshroomDistortionName(camera, version));
  if (name == kNoMeshroomLens) return {};
  const size_t count = name == "brown"                            ? 5
                       : name == "fisheye"                        ? 4
                       : name == "radialk1" || name == "fisheye1" ? 1
                                                                  : 3;
  LF_ASSIGN_OR_RETURN(const std::vector<double> p,
                      camera.NumbersAt("distortionParams", count, kMostMeshroomNumber));
  if (name == "fisheye") {
    k->distortion = {DistortionModel::kFisheye, {p[0], p[1], p[2], p[3]}};
  } else if (name == "fisheye1") {
    // An angle of 0 is no distortion.
    if (p[0] != 0) k->distortion = {DistortionModel::kFov, {p[0]}};
  } else if (name == "brown") {
    k->distortion =
        DistortionOf(DistortionModel::kRadialTangential, {p[0], p[1], p[3], p[4], p[2]});
  } else if (name == "radialk1") {
    k->distortion = DistortionOf(DistortionModel::kRadialTangential, {p[0]});
  } else {
    k->distortion = DistortionOf(DistortionModel::kRadialTangential, {p[0], p[1], 0, 0, p[2]});
  }
  if (name == "radialk3pt") {
    const double at_1 = 1 + p[0] + p[1] + p[2];
    k->fx_px /= at_1;
    k->fy_px /= at_1;
  }
  return {};
}

// Sets the focal lengths.
Result<void> ReadMeshroomFocal(const JsonValue& camera, const MeshroomVersion& version,
                               Intrinsics* k) {
  constexpr double kLeast = 1e-6;
  if (version < MeshroomVersion{1, 2, 0}) {
    LF_ASSIGN_OR_RETURN(k->fx_px, camera.NumberAt("pxFocalLength", kLeast, kMostMeshroomNumber));
    k->fy_px = k->fx_px;
    return {};
  }
  if (version < MeshroomVersion{1, 2, 2}) {
    LF_ASSIGN_OR_RETURN(const std::vector<double> focal,
                        camera.NumbersAt("pxFocalLength", 2, kMostMeshroomNumber));
    k->fx_px = focal[0];
    k->fy_px = focal[1];
    return {};
  }
  LF_ASSIGN_OR_RETURN(const double focal_mm,
                      camera.NumberAt("focalLength", kLeast, kMostMeshroomNumber));
  LF_ASSIGN_OR_RETURN(const double sensor_mm,
                      camera.NumberOr("sensorWidth", 36, kLeast, kMostMeshroomNumber));
  LF_ASSIGN_OR_RETURN(const double ratio,
                      camera.NumberOr("pixelRatio", 1, kLeast, kMostMeshroomNumber));
  if (version < MeshroomVersion{1, 2, 11}) {
    k->fx_px = focal_mm / sensor_mm * k->width_px;
    k->fy_px = version < MeshroomVersion{1, 2, 5} ? k->fx_px / ratio : k->fx_px * ratio;
  } else {
    k->fy_px = focal_mm / sensor_mm * std::max(k->width_px, k->height_px);
    k->fx_px = k->fy_px / ratio;
  }
  return {};
}

Result<Intrinsics> MeshroomIntrinsics(const JsonValue& camera, const MeshroomVersion& version) {
  constexpr int kMostSide_px = 65536;
  Intrinsics k;
  LF_ASSIGN_OR_RETURN(k.width_px, camera.WholeAt("width", 1, kMostSide_px));
  LF_ASSIGN_OR_RETURN(k.height_px, camera.WholeAt("height", 1, kMostSide_px));
  LF_RETURN_IF_ERROR(ReadMeshroomFocal(camera, version, &k));
  LF_RETURN_IF_ERROR(ReadMeshroomLens(camera, version, &k));
  LF_ASSIGN_OR_RETURN(const std::vector<double> point,
                      camera.NumbersAt("principalPoint", 2, kMostMeshroomNumber));
  const bool counts_from_middle = version >= MeshroomVersion{1, 2, 1};
  k.cx_px = point[0] + kWholeCentre_px + (counts_from_middle ? 0.5 * k.width_px : 0);
  k.cy_px = point[1] + kWholeCentre_px + (counts_from_middle ? 0.5 * k.height_px : 0);
  return k;
}

// Reads {"rotation": [9 numbers, column by column], "center": [3]}.
Result<RigidTransform> MeshroomPose(const JsonValue& pose) {
  LF_ASSIGN_OR_RETURN(const JsonValue matrix, pose.At("rotation"));
  LF_ASSIGN_OR_RETURN(const std::vector<double> columns, matrix.Numbers(9, 2));
  const Result<Mat3> transposed = RotationOfRows(columns);
  if (!transposed) return matrix.Fault(transposed.error().message);
  LF_ASSIGN_OR_RETURN(const std::vector<double> centre, pose.NumbersAt("center", 3, kLargest_w));
  return PoseAt(transposed->transpose(), Vec3(centre.data()));
}

// The entries to which the views of a scene refer by numbers, which are labels.
struct MeshroomScene {
  MeshroomVersion version;
  std::map<std::string, JsonValue> intrinsics, poses, rigs;
  std::map<std::string, Intrinsics> known;  // intrinsics that views have named
};

Result<void> IndexMeshroomList(const char* list, const char* key, const JsonValue& top,
                               std::map<std::string, JsonValue>* index) {
  LF_ASSIGN_OR_RETURN(const std::vector<JsonValue> entries, MeshroomList(top, list));
  for (const JsonValue& entry : entries) {
    LF_ASSIGN_OR_RETURN(const std::string label, entry.LabelAt(key));
    index->insert_or_assign(label, entry);
  }
  return {};
}

// Returns the pose of a camera relative to its rig.
Result<RigidTransform> MeshroomSubPose(const JsonValue& view, const MeshroomScene& scene) {
  LF_ASSIGN_OR_RETURN(const std::string rig_id, view.LabelAt("rigId"));
  const auto rig = scene.rigs.find(rig_id);
  if (rig == scene.rigs.end()) return view.At("rigId")->Wrong("the rigId of an entry of \"rigs\"");
  LF_ASSIGN_OR_RETURN(const std::vector<JsonValue> cameras, MeshroomList(rig->second, "subPoses"));
  LF_ASSIGN_OR_RETURN(const int index, view.WholeAt("subPoseId", 0, 1 << 20));
  if (static_cast<size_t>(index) >= cameras.size())
    return view.At("subPoseId")
        ->Wrong(fmt::format("less than the {} cameras of the rig", cameras.size()));
  LF_ASSIGN_OR_RETURN(const JsonValue pose, cameras[static_cast<size_t>(index)].At("pose"));
  return MeshroomPose(pose);
}

// Returns whether a view moves with its rig.
Result<bool> MovesWithRig(const JsonValue& view) {
  if (!view.Has("rigId") || !view.Has("isPoseIndependant")) return false;
  const Result<std::string> text = view.TextAt("isPoseIndependant");
  if (text) return *text == "false" || *text == "0";
  return view.At("isPoseIndependant")->Wrong("\"true\" or \"false\"");
}

Result<ExportedImage> MeshroomImage(const JsonValue& view, const JsonValue& pose_entry,
                                    MeshroomScene* scene) {
  ExportedImage image;
  LF_ASSIGN_OR_RETURN(image.name, view.TextAt("path"));
  LF_ASSIGN_OR_RETURN(const std::string id, view.LabelAt("intrinsicId"));
  if (scene->known.find(id) == scene->known.end()) {
    const auto camera = scene->intrinsics.find(id);
    if (camera == scene->intrinsics.end())
      return view.At("intrinsicId")->Wrong("the intrinsicId of an entry of \"intrinsics\"");
    LF_ASSIGN_OR_RETURN(scene->known[id], MeshroomIntrinsics(camera->second, scene->version));
  }
  image.intrinsics = scene->known[id];
  LF_ASSIGN_OR_RETURN(const JsonValue pose, pose_entry.At("pose"));
  LF_ASSIGN_OR_RETURN(const JsonValue transform, pose.At("transform"));
  LF_ASSIGN_OR_RETURN(image.cam_from_world, MeshroomPose(transform));
  LF_ASSIGN_OR_RETURN(const bool moves_with_rig, MovesWithRig(view));
  if (!moves_with_rig) return image;
  LF_ASSIGN_OR_RETURN(const RigidTransform cam_from_rig, MeshroomSubPose(view, *scene));
  image.cam_from_world = cam_from_rig * image.cam_from_world;
  return image;
}

}  // namespace

Result<ExportedCameras> ParseMeshroom(std::string_view text, const fs::path& file) {
  LF_ASSIGN_OR_RETURN(
      const nlohmann::json tree,
      ParseExportJson(text, file, {"structure", "metadata", "featuresFolders", "matchesFolders"}));
  const JsonValue top(tree, file);
  MeshroomScene scene;
  LF_ASSIGN_OR_RETURN(scene.version, MeshroomVersionOf(top));
  LF_RETURN_IF_ERROR(IndexMeshroomList("intrinsics", "intrinsicId", top, &scene.intrinsics));
  LF_RETURN_IF_ERROR(IndexMeshroomList("poses", "poseId", top, &scene.poses));
  LF_RETURN_IF_ERROR(IndexMeshroomList("rigs", "rigId", top, &scene.rigs));
  LF_ASSIGN_OR_RETURN(const std::vector<JsonValue> views, MeshroomList(top, "views"));
  ExportedCameras exported;
  exported.folder = file.parent_path();
  for (const JsonValue& view : views) {
    if (!view.Has("poseId")) continue;
    LF_ASSIGN_OR_RETURN(const std::string id, view.LabelAt("poseId"));
    const auto pose = scene.poses.find(id);
    if (pose == scene.poses.end()) continue;
    LF_ASSIGN_OR_RETURN(ExportedImage image, MeshroomImage(view, pose->second, &scene));
    exported.images.push_back(std::move(image));
  }
  LogPosedCount(file, exported.images.size(), views.size());
  return exported;
}

Result<LightField> ReadMeshroom(const fs::path& file, const ExportOptions& options) {
  return ReadExport(file, options, ParseMeshroom);
}

}  // namespace lf
