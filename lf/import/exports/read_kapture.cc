// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exports/read_kapture.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "lf/core/file.h"
#include "lf/core/parse_number.h"
#include "lf/import/exports/comma_fields.h"
#include "lf/import/exports/import_limits.h"
#include "lf/light_field/colmap/colmap_cameras.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

// A line with values.
struct KaptureLine {
  const fs::path& file;
  size_t number = 0;
  std::vector<std::string_view> fields;

  std::string_view Field(size_t i) const { return i < fields.size() ? fields[i] : ""; }
  Error Fault(std::string_view message) const {
    return InputError(fmt::format("{}: line {} {}", file.string(), number, message));
  }
  Result<double> Number(size_t i, const char* name, double most) const {
    const std::optional<double> value = ParseNumber(Field(i));
    if (!value || !(std::abs(*value) <= most))
      return Fault(fmt::format("has the {} \"{}\": expected a number within +-{:g}", name,
                               Field(i).substr(0, 80), most));
    return *value;
  }
};

// Calls take(line) for each line with values; ends at its first error.
template <class Take>
Result<void> ForLines(std::string_view text, const fs::path& file, const Take& take) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  for (size_t number = 1; !text.empty(); ++number) {
    const std::string_view line = TakeLine(&text);
    if (TrimmedField(line).empty() || line.starts_with('#')) continue;
    LF_RETURN_IF_ERROR(take(KaptureLine{file, number, CommaFields(line)}));
  }
  return {};
}

// Reads qw qx qy qz tx ty tz from field `first` on; none if a part of them is not stated.
Result<std::optional<RigidTransform>> KapturePose(const KaptureLine& line, size_t first) {
  constexpr const char* kNames[] = {"qw", "qx", "qy", "qz", "tx", "ty", "tz"};
  std::array<double, 7> p = {};
  for (size_t i = 0; i < p.size(); ++i)
    if (line.Field(first + i).empty()) return std::optional<RigidTransform>();
  for (size_t i = 0; i < p.size(); ++i) {
    LF_ASSIGN_OR_RETURN(p[i], line.Number(first + i, kNames[i], kLargest_w));
  }
  const Result<Mat3> rotation = RotationOfQuaternion(p[0], p[1], p[2], p[3]);
  if (!rotation) return line.Fault(rotation.error().message);
  return std::optional(RigidTransform{*rotation, {p[4], p[5], p[6]}});
}

Result<Intrinsics> KaptureIntrinsics(const KaptureLine& line) {
  constexpr size_t kModel = 3, kFirstNumber = 4;
  const Result<ColmapCameraModel> model = FindColmapCameraModel(line.Field(kModel));
  if (!model) return line.Fault(model.error().message);
  LF_ASSIGN_OR_RETURN(const double width, line.Number(kFirstNumber, "width", 1e9));
  LF_ASSIGN_OR_RETURN(const double height, line.Number(kFirstNumber + 1, "height", 1e9));
  if (!(width >= 1 && height >= 1) || width != std::floor(width) || height != std::floor(height))
    return line.Fault(
        fmt::format("has the size {} x {}: expected whole numbers above 0", width, height));
  std::vector<double> parameters;
  for (int i = 0; i < model->parameter_count; ++i) {
    LF_ASSIGN_OR_RETURN(const double parameter,
                        line.Number(kFirstNumber + 2 + static_cast<size_t>(i), "parameter", 1e9));
    parameters.push_back(parameter);
  }
  const Result<Intrinsics> k = IntrinsicsOfColmap(*model, static_cast<uint64_t>(width),
                                                  static_cast<uint64_t>(height), parameters);
  if (!k) return line.Fault(k.error().message);
  return k;
}

// A place in a rig.
struct RigMember {
  std::string rig;
  RigidTransform member_from_rig;
};

// A data set, in which sensors and rigs are called devices.
class KaptureSet {
 public:
  static Result<KaptureSet> Of(const KaptureTexts& texts, const fs::path& folder) {
    KaptureSet set;
    LF_RETURN_IF_ERROR(ForLines(texts.sensors, folder / "sensors.txt",
                                [&](const KaptureLine& line) -> Result<void> {
                                  if (line.Field(2) != "camera") return {};
                                  const std::string id(line.Field(0));
                                  if (line.Field(3) == "UNKNOWN_CAMERA") {
                                    set.unknown_.emplace(id, line.number);
                                    return {};
                                  }
                                  LF_ASSIGN_OR_RETURN(const Intrinsics k, KaptureIntrinsics(line));
                                  set.cameras_.emplace(id, k);
                                  return {};
                                }));
    LF_RETURN_IF_ERROR(
        ForLines(texts.rigs, folder / "rigs.txt", [&](const KaptureLine& line) -> Result<void> {
          LF_ASSIGN_OR_RETURN(const auto pose, KapturePose(line, 2));
          if (!pose)
            return line.Fault("has no place in its rig: expected qw, qx, qy, qz, tx, ty, tz");
          set.rigs_[std::string(line.Field(1))].push_back({std::string(line.Field(0)), *pose});
          return {};
        }));
    LF_RETURN_IF_ERROR(ForLines(texts.trajectories, folder / "trajectories.txt",
                                [&](const KaptureLine& line) -> Result<void> {
                                  LF_ASSIGN_OR_RETURN(const auto pose, KapturePose(line, 2));
                                  if (pose)
                                    set.poses_.emplace(KeyOf(line.Field(0), line.Field(1)), *pose);
                                  return {};
                                }));
    return set;
  }

  // Returns device_from_world; none if it is not stated. kInput, without a place, if rigs are in
  // each other.
  Result<std::optional<RigidTransform>> PoseOf(std::string_view timestamp,
                                               std::string_view device) const {
    int step_count = 0;
    return FindPose(timestamp, device, &step_count);
  }

  // Returns the intrinsics of a sensor. The message of kInput does not name the place.
  Result<Intrinsics> IntrinsicsOf(std::string_view sensor) const {
    if (const auto camera = cameras_.find(std::string(sensor)); camera != cameras_.end())
      return camera->second;
    if (const auto unknown = unknown_.find(std::string(sensor)); unknown != unknown_.end())
      return InputError(
          fmt::format("is of the sensor \"{}\", whose lens is not known (UNKNOWN_CAMERA, line {} "
                      "of sensors.txt): "
                      "reconstruct it first, and export the result",
                      sensor.substr(0, 80), unknown->second));
    return InputError(fmt::format("is of the sensor \"{}\", which is no camera of sensors.txt",
                                  sensor.substr(0, 80)));
  }

 private:
  // Rigs may be in rigs. A device that is in itself ends after some steps.
  Result<std::optional<RigidTransform>> FindPose(std::string_view timestamp,
                                                 std::string_view device, int* step_count) const {
    constexpr int kMostSteps = 500;
    if (++*step_count > kMostSteps) return InputError("belongs to rigs that are in each other");
    if (const auto pose = poses_.find(KeyOf(timestamp, device)); pose != poses_.end())
      return std::optional(pose->second);
    const auto rigs = rigs_.find(std::string(device));
    if (rigs == rigs_.end()) return std::optional<RigidTransform>();
    for (const RigMember& member : rigs->second) {
      LF_ASSIGN_OR_RETURN(const auto rig_from_world, FindPose(timestamp, member.rig, step_count));
      if (rig_from_world) return std::optional(member.member_from_rig * *rig_from_world);
    }
    return std::optional<RigidTransform>();
  }

  // Timestamps are whole numbers, of which 7 and 0007 are the same.
  static std::string KeyOf(std::string_view timestamp, std::string_view device) {
    if (const auto number = ParseWhole<int64_t>(timestamp))
      return fmt::format("{},{}", *number, device);
    return fmt::format("{},{}", timestamp, device);
  }

  std::map<std::string, Intrinsics> cameras_;
  std::map<std::string, size_t> unknown_;               // lines, by the sensor
  std::map<std::string, std::vector<RigMember>> rigs_;  // by the device in them
  std::map<std::string, RigidTransform> poses_;         // by KeyOf()
};

// Returns the text of a file, or "" if it is not there.
Result<std::string> TextIfThere(const fs::path& file) {
  std::error_code error;
  if (!fs::exists(file, error)) return std::string();
  return ReadFile(file, kMostExportBytes);
}

}  // namespace

Result<ExportedCameras> ParseKapture(const KaptureTexts& texts, const fs::path& folder) {
  LF_ASSIGN_OR_RETURN(const KaptureSet set, KaptureSet::Of(texts, folder));
  ExportedCameras cameras;
  cameras.folder = folder / "records_data";
  size_t record_count = 0;
  LF_RETURN_IF_ERROR(ForLines(
      texts.records, folder / "records_camera.txt", [&](const KaptureLine& line) -> Result<void> {
        ++record_count;
        const Result<std::optional<RigidTransform>> pose = set.PoseOf(line.Field(0), line.Field(1));
        if (!pose) return line.Fault(pose.error().message);
        if (!*pose) return {};
        const Result<Intrinsics> intrinsics = set.IntrinsicsOf(line.Field(1));
        if (!intrinsics) return line.Fault(intrinsics.error().message);
        cameras.images.push_back({std::string(line.Field(2)), *intrinsics, **pose});
        return {};
      }));
  LogPosedCount(folder, cameras.images.size(), record_count);
  return cameras;
}

Result<LightField> ReadKapture(const fs::path& file, const ExportOptions& options) {
  const fs::path folder = FolderAbove(file);
  LF_ASSIGN_OR_RETURN(const std::string sensors,
                      ReadFile(folder / "sensors.txt", kMostExportBytes));
  LF_ASSIGN_OR_RETURN(const std::string records,
                      ReadFile(folder / "records_camera.txt", kMostExportBytes));
  LF_ASSIGN_OR_RETURN(const std::string trajectories,
                      ReadFile(folder / "trajectories.txt", kMostExportBytes));
  LF_ASSIGN_OR_RETURN(const std::string rigs, TextIfThere(folder / "rigs.txt"));
  LF_ASSIGN_OR_RETURN(ExportedCameras cameras,
                      ParseKapture({sensors, records, trajectories, rigs}, folder));
  return FinishExport(std::move(cameras), file, options);
}

}  // namespace lf
