// SPDX-License-Identifier: Apache-2.0
#include "lf/import/paths/ngp_path.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include "lf/core/file.h"
#include "lf/import/paths/json_list.h"
#include "lf/import/paths/lf_camera_keys.h"
#include "lf/import/paths/ngp_curve.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr const char* kKeysKey = "path";
constexpr const char* kNgpTopKeys[] = {"lf_unit_m", "lf_fps",    "lf_resolution", "lf_frames",
                                       "lf_scale",  "lf_offset", "lf_views",      "lf_first_frame"};
// Films of files that state no duration last as long as instant-ngp's script makes them.
constexpr double kDefaultDuration_s = 1;

constexpr NumberRule kNgpNumber = {"from -1e6 to 1e6", [](double x) { return std::abs(x) <= 1e6; }};
constexpr NumberRule kNgpRadius = {"the radius of the lens, from 0 to 1e6",
                                   [](double x) { return x >= 0 && x <= 1e6; }};
constexpr NumberRule kNgpOrder = {"0, 1, 2 or 3",
                                  [](double x) { return x >= 0 && x <= 3 && x == std::floor(x); }};
constexpr NumberRule kNgpTime = {"seconds from 0 to 1e9",
                                 [](double x) { return x >= 0 && x <= 1e9; }};
constexpr NumberRule kNgpRate = {"frames per second from 0.001 to 1e6",
                                 [](double x) { return x >= 1e-3 && x <= 1e6; }};
constexpr NumberRule kNgpScale = {"a factor from 1e-9 to 1e9",
                                  [](double x) { return x >= 1e-9 && x <= 1e9; }};
constexpr NumberRule kNgpSide = {"a whole number from 1 to 65536", [](double x) {
                                   return x >= 1 && x <= kLargestPlateSide_px && x == std::floor(x);
                                 }};
constexpr NumberRule kNgpFrames = {
    "the number of frames, which are the first entries of \"path\"",
    [](double x) { return x >= 1 && x <= kMostFrames && x == std::floor(x); }};

// The quantities that the file states besides its keyframes.
struct NgpHead {
  NgpCurve curve;  // without keys
  double duration_s = 0;
  std::optional<size_t> frame_count;  // set if the keyframes are the frames
  std::array<int, 2> resolution_px = {};
  NgpSpace space;
};

// Reads the keys `scale_key` and `offset_key`, which transforms.json and our own files have.
Result<void> ReadSpace(const JsonFields& top, const char* scale_key, const char* offset_key,
                       NgpSpace* space) {
  LF_ASSIGN_OR_RETURN(const std::optional<double> scale, top.Number(scale_key, kNgpScale));
  if (scale) space->scale = *scale;
  LF_ASSIGN_OR_RETURN(const std::optional<std::vector<double>> offset,
                      top.NumberOrNumbers(offset_key, 3, kNgpNumber));
  if (offset) space->offset = Vec3(offset->data());
  return {};
}

Result<void> ReadResolution(const JsonFields& top, const PathOptions& options, NgpHead* head,
                            ForeignPath* path) {
  LF_ASSIGN_OR_RETURN(const std::optional<std::vector<double>> sides,
                      top.Numbers("lf_resolution", 2, 2, kNgpSide));
  if (!sides) {
    head->resolution_px = ResolutionOr(options, path);
    return {};
  }
  if ((*sides)[0] * (*sides)[1] > static_cast<double>(kMostPlateElements))
    return top.Wrong("lf_resolution", fmt::format("at most {} elements", kMostPlateElements));
  head->resolution_px = {static_cast<int>((*sides)[0]), static_cast<int>((*sides)[1])};
  return {};
}

Result<void> ReadClock(const JsonFields& top, const PathOptions& options, NgpHead* head,
                       ForeignPath* path) {
  LF_ASSIGN_OR_RETURN(const std::optional<double> fps, top.Number("lf_fps", kNgpRate));
  path->fps = fps ? *fps : FpsOr(options, path);
  LF_ASSIGN_OR_RETURN(const std::optional<double> duration_s,
                      top.Number("duration_seconds", kNgpTime));
  head->duration_s = duration_s.value_or(0) > 0 ? *duration_s : kDefaultDuration_s;
  LF_ASSIGN_OR_RETURN(const std::optional<double> frames, top.Number("lf_frames", kNgpFrames));
  if (!frames && top.Has("lf_views"))
    return top.Wrong("lf_views", "no such key without \"lf_frames\", because a curve has no views");
  if (!frames) return {};
  if (*frames > static_cast<double>(top.ListSize(kKeysKey).value_or(0)))
    return top.Wrong("lf_frames", kNgpFrames.expected);
  head->frame_count = static_cast<size_t>(*frames);
  LF_ASSIGN_OR_RETURN(path->views, ViewsOfKey(top));
  return {};
}

Result<void> ReadHead(const JsonFields& top, const PathOptions& options, NgpHead* head,
                      ForeignPath* path) {
  LF_RETURN_IF_ERROR(top.CheckLfKeys(kNgpTopKeys, kLfCameraKeys, "into each keyframe"));
  constexpr NumberRule kUnit = {"metres per world unit, from 1e-9 to 1e9",
                                [](double x) { return x >= 1e-9 && x <= 1e9; }};
  LF_ASSIGN_OR_RETURN(path->unit_m, top.Number("lf_unit_m", kUnit));
  LF_ASSIGN_OR_RETURN(path->first_frame, FirstFrameOfKey(top));
  LF_RETURN_IF_ERROR(ReadClock(top, options, head, path));
  LF_RETURN_IF_ERROR(ReadResolution(top, options, head, path));
  LF_RETURN_IF_ERROR(ReadSpace(top, "lf_scale", "lf_offset", &head->space));
  LF_ASSIGN_OR_RETURN(const std::optional<double> order, top.Number("spline_order", kNgpOrder));
  head->curve.spline_order = static_cast<int>(order.value_or(3));
  LF_ASSIGN_OR_RETURN(const std::optional<bool> loop, top.Bool("loop"));
  head->curve.loop = loop.value_or(false);
  return {};
}

// Reads the numbers of a keyframe, with the field of view in degrees. Older files call
// aperture_size "dof".
Result<NgpNumbers> NumbersOfKey(const JsonFields& key, const PathOptions& options,
                                ForeignPath* path) {
  NgpNumbers numbers;
  LF_ASSIGN_OR_RETURN(const std::optional<std::vector<double>> rotation,
                      key.Numbers("R", 4, 4, kNgpNumber));
  if (!rotation) return key.Wrong("R", "the quaternion [x, y, z, w]");
  numbers.head<4>() = Eigen::Vector4d(rotation->data());
  const double length = numbers.head<4>().norm();
  if (!(length > 1e-3)) return key.Wrong("R", "a quaternion [x, y, z, w] of length 1");
  numbers.head<4>() /= length;
  LF_ASSIGN_OR_RETURN(const std::optional<std::vector<double>> position,
                      key.Numbers("T", 3, 3, kNgpNumber));
  if (!position) return key.Wrong("T", "the position [x, y, z]");
  numbers.segment<3>(4) = Vec3(position->data());
  const char* const aperture = key.Has("dof") ? "dof" : "aperture_size";
  const std::pair<const char*, NumberRule> rest[] = {{"slice", kNgpNumber},
                                                     {"scale", kNgpNumber},
                                                     {"fov", FovRule(options)},
                                                     {aperture, kNgpRadius}};
  int index = 7;
  for (const auto& [name, rule] : rest) {
    LF_ASSIGN_OR_RETURN(const std::optional<double> number, key.Number(name, rule));
    if (!number) return key.Wrong(name, rule.expected);
    numbers[index++] = *number;
  }
  numbers[9] = FovDeg(numbers[9], options, path);
  return numbers;
}

// Returns the camera in instant-ngp's space.
ForeignCamera CameraOfNumbers(const NgpNumbers& n, const std::array<int, 2>& resolution_px) {
  ForeignCamera camera;
  const Mat3 world_from_cam = Eigen::Quaterniond(n[3], n[0], n[1], n[2]).toRotationMatrix();
  camera.pinhole.cam_from_world = RigidTransform{world_from_cam, n.segment<3>(4)}.Inverse();
  camera.pinhole.intrinsics = IntrinsicsOfFov(n[9], resolution_px);
  // A pinhole may have any focus; instant-ngp then allows a plane behind the camera.
  if (n[7] + n[8] > 0 || n[10] > 0) camera.focus_distance_w = n[7] + n[8];
  camera.aperture_diameter_w = 2 * n[10];
  return camera;
}

// Returns the number of frames to be filmed from a curve.
Result<size_t> FrameCount(const NgpHead& head, const fs::path& file, const PathOptions& options,
                          ForeignPath* path) {
  if (options.frame_count) return size_t{*options.frame_count};
  if (head.curve.keys.size() == 1) return size_t{1};
  const double count = std::round(head.duration_s * path->fps);
  if (!(count <= kMostFrames))
    return InputError(
        fmt::format("{}: {} s at {} frames per second are more than {} frames: give "
                    "their number ({{lfpath frames}})",
                    file.string(), head.duration_s, path->fps, kMostFrames));
  const size_t frames = std::max(size_t{1}, static_cast<size_t>(count));
  path->lacks.push_back(fmt::format("no number of frames ({} are used, for {} s; set {{frames}})",
                                    frames, head.duration_s));
  return frames;
}

Result<void> Film(const NgpHead& head, const fs::path& file, const PathOptions& options,
                  ForeignPath* path) {
  LF_ASSIGN_OR_RETURN(const size_t count, FrameCount(head, file, options, path));
  const Similarity world_from_ngp = InverseOf(NgpFromWorld(head.space));
  for (size_t i = 0; i < count; ++i) {
    const double t = static_cast<double>(i) / static_cast<double>(count);
    path->cameras.push_back(CameraOfNumbers(At(head.curve, t), head.resolution_px));
    MoveInto(world_from_ngp, &path->cameras.back());
  }
  return {};
}

}  // namespace

Similarity NgpFromWorld(const NgpSpace& space) {
  Mat3 cycled;  // (x, y, z) becomes (y, z, x)
  cycled << 0, 1, 0, 0, 0, 1, 1, 0, 0;
  return {space.scale, cycled, cycled * space.offset};
}

Result<NgpSpace> NgpSpaceFor(const fs::path& file, const PathOptions& options) {
  NgpSpace space;
  const fs::path of_field = options.light_field;
  for (const fs::path& candidate :
       {of_field, of_field / "transforms.json", file.parent_path() / "transforms.json"}) {
    std::error_code error;
    if (candidate.extension() != ".json" || !fs::is_regular_file(candidate, error)) continue;
    JsonObject object;
    LF_RETURN_IF_ERROR(ReadTopLevel(candidate, "frames", &object));
    LF_RETURN_IF_ERROR(ReadSpace(JsonFields(object, candidate), "scale", "offset", &space));
    break;
  }
  if (options.ngp_scale) space.scale = *options.ngp_scale;
  if (options.ngp_offset) space.offset = *options.ngp_offset;
  return space;
}

Result<ForeignPath> ParseNgpPath(std::string_view text, const fs::path& file,
                                 const PathOptions& options, const NgpSpace& space) {
  ForeignPath path;
  NgpHead head;
  head.space = space;
  bool states_intrinsics = false;
  const auto read_top = [&](const JsonFields& top) { return ReadHead(top, options, &head, &path); };
  const auto read_key = [&](const JsonFields& key) -> Result<void> {
    LF_RETURN_IF_ERROR(key.CheckLfKeys(kLfCameraKeys, kNgpTopKeys, "to the top level"));
    LF_ASSIGN_OR_RETURN(const NgpNumbers numbers, NumbersOfKey(key, options, &path));
    LF_ASSIGN_OR_RETURN(const std::optional<double> timestamp, key.Number("timestamp", kNgpTime));
    head.curve.keys.push_back(numbers);
    head.curve.timestamps.push_back(timestamp.value_or(0));
    if (!head.frame_count || path.cameras.size() == *head.frame_count) return {};
    ForeignCamera camera = CameraOfNumbers(numbers, head.resolution_px);
    MoveInto(InverseOf(NgpFromWorld(head.space)), &camera);
    LF_RETURN_IF_ERROR(ReadLfCameraKeys(key, &camera));
    states_intrinsics = states_intrinsics || key.Has(kLfIntrinsicsKey);
    path.cameras.push_back(camera);
    return {};
  };
  LF_RETURN_IF_ERROR(ReadJsonList(text, file, kKeysKey, read_top, read_key));
  if (states_intrinsics) path.largest_fov = std::nullopt;
  if (head.frame_count) return path;
  RepairTimestamps(&head.curve);
  LF_RETURN_IF_ERROR(Film(head, file, options, &path));
  return path;
}

Result<ForeignPath> ReadNgpPath(const fs::path& file, const PathOptions& options) {
  LF_ASSIGN_OR_RETURN(const std::string text, ReadFile(file, kMaxPathBytes));
  LF_ASSIGN_OR_RETURN(const NgpSpace space, NgpSpaceFor(file, options));
  return ParseNgpPath(text, file, options, space);
}

}  // namespace lf
