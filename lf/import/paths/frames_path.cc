// SPDX-License-Identifier: Apache-2.0
#include "lf/import/paths/frames_path.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "lf/core/file.h"
#include "lf/core/log.h"
#include "lf/import/paths/json_list.h"
#include "lf/light_field/colmap/read_colmap.h"
#include "lf/light_field/model/rotation.h"
#include "lf/light_field/transforms_json/transforms_json.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr const char* kSplatList = "cameras";  // name of the list in messages
constexpr double kSplatRotationTolerance = 1e-3;

constexpr NumberRule kPlace = {"from -1e12 to 1e12", [](double x) { return std::abs(x) <= 1e12; }};
constexpr NumberRule kFocal = {"pixels above 0, at most 1e9",
                               [](double x) { return x > 0 && x <= 1e9; }};
constexpr NumberRule kImageSide = {
    "a whole number of pixels from 1 to 65536",
    [](double x) { return x >= 1 && x <= kLargestPlateSide_px && x == std::floor(x); }};

// Returns kInput if the plates of two frames have different sizes.
Result<void> CheckSizes(const ForeignPath& path, const fs::path& file, const PathOptions& options) {
  const Intrinsics& first = path.cameras[0].pinhole.intrinsics;
  for (size_t i = 0; i < path.cameras.size() && !options.resolution_px; ++i) {
    const Intrinsics& k = path.cameras[i].pinhole.intrinsics;
    if (k.width_px != first.width_px || k.height_px != first.height_px)
      return InputError(fmt::format(
          "{}: camera {} has {} x {} pixels, but the first has {} x {}, and the frames of a film "
          "have one size: state it ({{lfpath resolution}})",
          file.string(), i + 1, k.width_px, k.height_px, first.width_px, first.height_px));
  }
  if (first.width_px > kLargestPlateSide_px || first.height_px > kLargestPlateSide_px)
    return InputError(
        fmt::format("{}: the first camera has {} x {} pixels: expected at most {} on "
                    "each side",
                    file.string(), first.width_px, first.height_px, kLargestPlateSide_px));
  return {};
}

// Reads a number that must not be missing.
Result<double> NumberIn(const JsonFields& entry, const char* key, const NumberRule& rule) {
  LF_ASSIGN_OR_RETURN(const std::optional<double> number, entry.Number(key, rule));
  if (!number) return entry.Wrong(key, rule.expected);
  return *number;
}

Result<RigidTransform> PoseOfSplat(const JsonFields& entry) {
  LF_ASSIGN_OR_RETURN(const std::optional<std::vector<double>> matrix,
                      entry.Matrix("rotation", 3, 3, 3, kPlace));
  if (!matrix) return entry.Wrong("rotation", "3 lists of 3 numbers");
  const Result<Mat3> world_from_cam = NearestRotation(
      Mat3(Eigen::Matrix<double, 3, 3, Eigen::RowMajor>(matrix->data())), kSplatRotationTolerance);
  if (!world_from_cam) return entry.Fault("\"rotation\" " + world_from_cam.error().message);
  LF_ASSIGN_OR_RETURN(const std::optional<std::vector<double>> position,
                      entry.Numbers("position", 3, 3, kPlace));
  if (!position) return entry.Wrong("position", "the position [x, y, z]");
  return RigidTransform{*world_from_cam, Vec3(position->data())}.Inverse();
}

Result<ForeignCamera> CameraOfSplat(const JsonFields& entry) {
  ForeignCamera camera;
  LF_ASSIGN_OR_RETURN(camera.pinhole.cam_from_world, PoseOfSplat(entry));
  Intrinsics& k = camera.pinhole.intrinsics;
  LF_ASSIGN_OR_RETURN(k.fx_px, NumberIn(entry, "fx", kFocal));
  LF_ASSIGN_OR_RETURN(k.fy_px, NumberIn(entry, "fy", kFocal));
  LF_ASSIGN_OR_RETURN(const double width_px, NumberIn(entry, "width", kImageSide));
  LF_ASSIGN_OR_RETURN(const double height_px, NumberIn(entry, "height", kImageSide));
  if (width_px * height_px > static_cast<double>(kMostPlateElements))
    return entry.Fault(fmt::format("has {} x {} pixels: expected at most {}", width_px, height_px,
                                   kMostPlateElements));
  k.width_px = static_cast<int>(width_px);
  k.height_px = static_cast<int>(height_px);
  k.cx_px = width_px / 2;
  k.cy_px = height_px / 2;
  return camera;
}

}  // namespace

Result<ForeignPath> FramesOf(const LightField& light_field, const fs::path& file,
                             const PathOptions& options) {
  ForeignPath path;
  path.fps = FpsOr(options, &path);
  path.depth_range = light_field.depth_range;
  // 1 is what a calibration has that states no unit.
  if (light_field.unit_m != 1) path.unit_m = light_field.unit_m;
  if (light_field.size() > kMostFrames)
    return InputError(fmt::format("{}: has {} cameras: expected at most {} frames", file.string(),
                                  light_field.size(), kMostFrames));
  size_t distorted = 0;
  for (uint32_t i = 0; i < light_field.size(); ++i) {
    ForeignCamera camera;
    camera.pinhole = light_field.Camera({i});
    distorted += camera.pinhole.intrinsics.has_distortion();
    camera.pinhole.intrinsics.distortion = {};
    camera.pinhole.intrinsics.vignetting = {};
    path.cameras.push_back(camera);
  }
  LF_RETURN_IF_ERROR(CheckSizes(path, file, options));
  if (distorted > 0)
    LogWarning(
        "{}: {} of {} cameras have lens distortion, which frames do not have: compare the frames "
        "with undistorted images",
        file.string(), distorted, light_field.size());
  return path;
}

Result<ForeignPath> ReadTransformsFrames(const fs::path& file, const PathOptions& options) {
  LF_ASSIGN_OR_RETURN(const LightField light_field, ReadTransformsJson(file));
  return FramesOf(light_field, file, options);
}

Result<ForeignPath> ReadColmapFrames(const fs::path& model_folder, const PathOptions& options) {
  LF_ASSIGN_OR_RETURN(ColmapStreams streams, OpenColmapStreams(model_folder));
  LF_ASSIGN_OR_RETURN(const LightField light_field, ParseColmapModel(std::move(streams)));
  return FramesOf(light_field, model_folder, options);
}

Result<ForeignPath> ParseSplatCameras(std::string_view text, const fs::path& file,
                                      const PathOptions& options) {
  ForeignPath path;
  path.fps = FpsOr(options, &path);
  const auto read_camera = [&](const JsonFields& entry) -> Result<void> {
    LF_ASSIGN_OR_RETURN(const ForeignCamera camera, CameraOfSplat(entry));
    path.cameras.push_back(camera);
    return {};
  };
  LF_RETURN_IF_ERROR(ReadJsonList(
      text, file, kSplatList, [](const JsonFields&) { return Result<void>(); }, read_camera));
  LF_RETURN_IF_ERROR(CheckSizes(path, file, options));
  return path;
}

Result<ForeignPath> ReadSplatCameras(const fs::path& file, const PathOptions& options) {
  LF_ASSIGN_OR_RETURN(const std::string text, ReadFile(file, kMaxPathBytes));
  return ParseSplatCameras(text, file, options);
}

}  // namespace lf
