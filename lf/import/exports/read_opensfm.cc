// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exports/read_opensfm.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "lf/core/log.h"
#include "lf/import/exports/export_json.h"
#include "lf/import/exports/import_limits.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr double kMostOpenSfmNumber = 1e9;

// The value of a parameter of a camera; 0 if it is not stated.
Result<double> OpenSfmNumber(const JsonValue& camera, const char* key) {
  return camera.NumberOr(key, 0, -kMostOpenSfmNumber, kMostOpenSfmNumber);
}

// Reads parameters by their keys, in the order of the distortion model.
Result<Distortion> OpenSfmDistortion(const JsonValue& camera, DistortionModel model,
                                     std::initializer_list<const char*> keys) {
  DistortionParameters parameters = {};
  size_t i = 0;
  for (const char* const key : keys) {
    LF_ASSIGN_OR_RETURN(parameters[i], OpenSfmNumber(camera, key));
    ++i;
  }
  return DistortionOf(model, parameters);
}

// Reads the distortions fisheye62 and fisheye624. Their tangential and prism terms are functions of
// the undistorted position, as in kThinPrism, which has k1 to k4 alone. Without these terms, they
// are the radial part of kRadialTangentialThinPrism.
Result<Distortion> OpenSfmFisheye6(const JsonValue& camera) {
  LF_ASSIGN_OR_RETURN(
      const Distortion prism,
      OpenSfmDistortion(camera, DistortionModel::kThinPrism,
                        {"k1", "k2", "p1", "p2", "k3", "k4", "s0", "s2", "k5", "k6", "s1", "s3"}));
  const DistortionParameters& p = prism.parameters;
  if (p[8] == 0 && p[9] == 0 && p[10] == 0 && p[11] == 0)
    return Distortion{DistortionModel::kThinPrism,
                      {p[0], p[1], p[2], p[3], p[4], p[5], p[6], p[7]}};
  if (p[2] != 0 || p[3] != 0 || p[6] != 0 || p[7] != 0 || p[10] != 0 || p[11] != 0)
    return camera.Fault(
        "has the lens model fisheye62 or fisheye624 with k5, k6, s1 or s3 beside other terms than "
        "k1 to k6, which is not supported: expected k5, k6, s1 and s3 of 0, or k1 to k6 alone");
  return Distortion{DistortionModel::kRadialTangentialThinPrism,
                    {p[0], p[1], p[4], p[5], p[8], p[9]}};
}

// Returns the distortion of a camera. Sets `has_affine` to true if its model has two focal lengths
// and a principal point.
Result<Distortion> OpenSfmLens(const JsonValue& camera, bool* has_affine) {
  using Model = DistortionModel;
  std::string type = "perspective";
  if (camera.Has("projection_type")) {
    LF_ASSIGN_OR_RETURN(type, camera.TextAt("projection_type"));
  }
  if (type == "dual") {
    LF_ASSIGN_OR_RETURN(const double transition, camera.NumberOr("transition", 0.5, 0, 1));
    if (transition == 0) type = "fisheye";
    if (transition == 1) type = "perspective";
  }
  *has_affine = type != "perspective" && type != "fisheye";
  if (type == "perspective" || type == "radial")
    return OpenSfmDistortion(camera, Model::kRadialTangential, {"k1", "k2"});
  if (type == "simple_radial") return OpenSfmDistortion(camera, Model::kRadialTangential, {"k1"});
  if (type == "brown")
    return OpenSfmDistortion(camera, Model::kRadialTangential, {"k1", "k2", "p1", "p2", "k3"});
  if (type == "fisheye") return OpenSfmDistortion(camera, Model::kFisheye, {"k1", "k2"});
  if (type == "fisheye_opencv")
    return OpenSfmDistortion(camera, Model::kFisheye, {"k1", "k2", "k3", "k4"});
  if (type == "fisheye62" || type == "fisheye624") return OpenSfmFisheye6(camera);
  return camera.Fault(fmt::format(
      "has the lens model \"{}\", which is not supported: expected perspective, simple_radial, "
      "radial, brown, fisheye, fisheye_opencv, fisheye62 or fisheye624",
      type.substr(0, 80)));
}

Result<Intrinsics> OpenSfmIntrinsics(const JsonValue& camera) {
  constexpr int kMostSide_px = 65536;
  constexpr double kLeastFocal = 1e-6, kMostFocal = 1e6, kMostOffset = 1e3;
  Intrinsics k;
  bool has_affine = false;
  LF_ASSIGN_OR_RETURN(k.distortion, OpenSfmLens(camera, &has_affine));
  LF_ASSIGN_OR_RETURN(k.width_px, camera.WholeAt("width", 1, kMostSide_px));
  LF_ASSIGN_OR_RETURN(k.height_px, camera.WholeAt("height", 1, kMostSide_px));
  const double size_px = std::max(k.width_px, k.height_px);
  const auto focal = [&](const char* key) { return camera.NumberAt(key, kLeastFocal, kMostFocal); };
  LF_ASSIGN_OR_RETURN(const double fx, focal(has_affine ? "focal_x" : "focal"));
  LF_ASSIGN_OR_RETURN(const double fy, focal(has_affine ? "focal_y" : "focal"));
  k.fx_px = size_px * fx;
  k.fy_px = size_px * fy;
  k.cx_px = 0.5 * k.width_px;
  k.cy_px = 0.5 * k.height_px;
  if (!has_affine) return k;
  LF_ASSIGN_OR_RETURN(const double cx, camera.NumberOr("c_x", 0, -kMostOffset, kMostOffset));
  LF_ASSIGN_OR_RETURN(const double cy, camera.NumberOr("c_y", 0, -kMostOffset, kMostOffset));
  k.cx_px += size_px * cx;
  k.cy_px += size_px * cy;
  return k;
}

Result<RigidTransform> OpenSfmPose(const JsonValue& shot) {
  constexpr double kMostAngle = 1e3;
  LF_ASSIGN_OR_RETURN(const JsonValue turn, shot.At("rotation"));
  LF_ASSIGN_OR_RETURN(const std::vector<double> axis_angle, turn.Numbers(3, kMostAngle));
  const Result<Mat3> rotation = RotationOfAxisAngle(Vec3(axis_angle.data()));
  if (!rotation) return turn.Fault(rotation.error().message);
  LF_ASSIGN_OR_RETURN(const std::vector<double> translation,
                      shot.NumbersAt("translation", 3, kLargest_w));
  return RigidTransform{*rotation, Vec3(translation.data())};
}

Result<ExportedCameras> OpenSfmShots(const JsonValue& reconstruction) {
  LF_ASSIGN_OR_RETURN(const JsonValue cameras, reconstruction.At("cameras"));
  LF_ASSIGN_OR_RETURN(const JsonValue shots, reconstruction.At("shots"));
  LF_ASSIGN_OR_RETURN(const auto members, shots.Members());
  std::map<std::string, Intrinsics> known;  // intrinsics of the cameras that shots name
  ExportedCameras exported;
  for (const auto& [name, shot] : members) {
    ExportedImage image;
    image.name = name;
    LF_ASSIGN_OR_RETURN(const std::string id, shot.TextAt("camera"));
    if (known.find(id) == known.end()) {
      if (!cameras.Has(id)) return shot.At("camera")->Wrong("a key of \"cameras\"");
      LF_ASSIGN_OR_RETURN(const JsonValue camera, cameras.At(id));
      LF_ASSIGN_OR_RETURN(known[id], OpenSfmIntrinsics(camera));
    }
    image.intrinsics = known[id];
    LF_ASSIGN_OR_RETURN(image.cam_from_world, OpenSfmPose(shot));
    exported.images.push_back(std::move(image));
  }
  return exported;
}

// Returns the number of shots of a reconstruction.
Result<size_t> OpenSfmCount(const JsonValue& reconstruction) {
  LF_ASSIGN_OR_RETURN(const JsonValue shots, reconstruction.At("shots"));
  LF_ASSIGN_OR_RETURN(const auto members, shots.Members());
  return members.size();
}

}  // namespace

Result<ExportedCameras> ParseOpenSfm(std::string_view text, const fs::path& file) {
  LF_ASSIGN_OR_RETURN(const nlohmann::json tree,
                      ParseExportJson(text, file, {"points", "covariance", "vertices", "faces"}));
  const JsonValue top(tree, file);
  LF_ASSIGN_OR_RETURN(const std::vector<JsonValue> all, top.Entries());
  if (all.empty()) return top.Fault("is an empty list: expected a reconstruction");
  size_t best = 0, best_count = 0, count = 0;
  for (size_t i = 0; i < all.size(); ++i) {
    LF_ASSIGN_OR_RETURN(const size_t shot_count, OpenSfmCount(all[i]));
    count += shot_count;
    if (shot_count <= best_count) continue;
    best = i;
    best_count = shot_count;
  }
  if (count > best_count)
    LogWarning(
        "{}: holds {} reconstructions that are not connected with each other: the largest, of {} "
        "of {} images, is read",
        file.string(), all.size(), best_count, count);
  LF_ASSIGN_OR_RETURN(ExportedCameras exported, OpenSfmShots(all[best]));
  exported.folder = file.parent_path();
  return exported;
}

Result<LightField> ReadOpenSfm(const fs::path& file, const ExportOptions& options) {
  return ReadExport(
      file, options, [](std::string_view text, const fs::path& path) -> Result<ExportedCameras> {
        LF_ASSIGN_OR_RETURN(ExportedCameras exported, ParseOpenSfm(text, path));
        const fs::path folder = FolderAbove(path);
        exported.folder = FolderWithImages(
            exported.images, {folder / kImagesName, folder, folder / ".." / kImagesName}, folder);
        return exported;
      });
}

}  // namespace lf
