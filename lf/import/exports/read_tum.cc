// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exports/read_tum.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "lf/core/file.h"
#include "lf/import/exports/export_words.h"
#include "lf/import/exports/import_limits.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr double kMostTumTime_s = 1e12;
constexpr double kMostGap_s = 0.1;  // between two poses, for a pose between them
constexpr size_t kLongestTumName = 4096;
constexpr double kMostDistance_s = 0.02;  // from the nearest pose

struct TimedPose {
  double time_s = 0;
  Eigen::Quaterniond world_from_cam = Eigen::Quaterniond::Identity();
  Vec3 centre = Vec3::Zero();
};

Result<std::vector<TimedPose>> TumPoses(std::string_view text, const fs::path& file) {
  ExportWords words(text, file);
  std::vector<TimedPose> poses;
  while (words.Advance()) {
    if (poses.size() == kMaxImageCount)
      return words.Fault(fmt::format("has more than {} poses", kMaxImageCount));
    LF_ASSIGN_OR_RETURN(const std::vector<double> n,
                        words.NumbersOfLine("time x y z qx qy qz qw", 8, kLargest_w));
    const Result<Mat3> rotation = RotationOfQuaternion(n[7], n[4], n[5], n[6]);
    if (!rotation) return words.Fault("the quaternion " + rotation.error().message);
    const TimedPose pose = {
        n[0], Eigen::Quaterniond(n[7], n[4], n[5], n[6]).normalized(), {n[1], n[2], n[3]}};
    if (!poses.empty() && !(pose.time_s > poses.back().time_s))
      return words.Fault(fmt::format(
          "the time {} is not later than the one before, {}: expected poses in the order "
          "of their times",
          pose.time_s, poses.back().time_s));
    poses.push_back(pose);
  }
  return poses;
}

RigidTransform PoseOfTum(const TimedPose& pose) {
  return PoseAt(pose.world_from_cam.toRotationMatrix().transpose(), pose.centre);
}

// Returns the pose at a time; none if no pose is near.
std::optional<RigidTransform> TumPoseAt(const std::vector<TimedPose>& poses, double time_s) {
  const auto after = std::lower_bound(
      poses.begin(), poses.end(), time_s,
      [](const TimedPose& pose, double wanted_s) { return pose.time_s < wanted_s; });
  if (after != poses.end() && after->time_s == time_s) return PoseOfTum(*after);
  if (after != poses.end() && after != poses.begin()) {
    const TimedPose& a = *(after - 1);
    const double gap_s = after->time_s - a.time_s;
    if (gap_s <= kMostGap_s) {
      const double share = (time_s - a.time_s) / gap_s;
      return PoseOfTum({time_s, a.world_from_cam.slerp(share, after->world_from_cam),
                        a.centre + share * (after->centre - a.centre)});
    }
  }
  if (after != poses.end() && after->time_s - time_s <= kMostDistance_s &&
      (after == poses.begin() || after->time_s - time_s <= time_s - (after - 1)->time_s))
    return PoseOfTum(*after);
  if (after != poses.begin() && time_s - (after - 1)->time_s <= kMostDistance_s)
    return PoseOfTum(*(after - 1));
  return std::nullopt;
}

}  // namespace

Result<ExportedCameras> ParseTum(std::string_view text, const fs::path& file, std::string_view list,
                                 const fs::path& list_file, double focal_px) {
  LF_ASSIGN_OR_RETURN(const std::vector<TimedPose> poses, TumPoses(text, file));
  ExportedCameras exported;
  exported.folder = list_file.parent_path();
  exported.counts_from_middle = true;
  ExportWords words(list, list_file);
  size_t count = 0;
  for (; words.Advance(); ++count) {
    if (count == kMaxImageCount)
      return words.Fault(fmt::format("names more than {} images", kMaxImageCount));
    LF_ASSIGN_OR_RETURN(const double time_s, words.Number("the time of an image", kMostTumTime_s));
    std::string name = words.line().Rest(kLongestTumName);
    if (name.empty() || name.size() > kLongestTumName)
      return words.Fault(
          fmt::format("expected a time and a name of 1 to {} bytes", kLongestTumName));
    const std::optional<RigidTransform> pose = TumPoseAt(poses, time_s);
    if (!pose) continue;
    ExportedImage image;
    image.name = std::move(name);
    image.intrinsics.fx_px = image.intrinsics.fy_px = focal_px;
    image.cam_from_world = *pose;
    exported.images.push_back(std::move(image));
  }
  LogPosedCount(file, exported.images.size(), count);
  return exported;
}

Result<LightField> ReadTum(const fs::path& file, const ExportOptions& options) {
  const fs::path list_file = FolderAbove(file) / "rgb.txt";
  std::error_code error;
  if (!fs::is_regular_file(list_file, error))
    return InputError(fmt::format(
        "{}: the list of the images is missing: expected rgb.txt beside it, with the time and the "
        "name of an image on each line",
        file.string()));
  if (!options.focal_px)
    return InputError(fmt::format(
        "{}: holds poses, but does not state the focal length of the camera: give it in "
        "pixels ({{focal_px}}; cameras of TUM's benchmark have about 525)",
        file.string()));
  LF_ASSIGN_OR_RETURN(const std::string text, ReadFile(file, kMostExportBytes));
  LF_ASSIGN_OR_RETURN(const std::string list, ReadFile(list_file, kMostExportBytes));
  LF_ASSIGN_OR_RETURN(ExportedCameras exported,
                      ParseTum(text, file, list, list_file, *options.focal_px));
  return FinishExport(std::move(exported), file, options);
}

}  // namespace lf
