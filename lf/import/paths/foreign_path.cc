// SPDX-License-Identifier: Apache-2.0
#include "lf/import/paths/foreign_path.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "lf/camera/resolution.h"
#include "lf/core/log.h"

namespace lf {
namespace {

// Limits of the quantities, as those of our own paths.
constexpr double kLargestLength_w = 1e9;
constexpr double kLeastHalfView = 1e-6, kMostHalfView = 1e4;

Error FrameError(const std::filesystem::path& file, FrameId frame, const std::string& message) {
  return InputError(fmt::format("{}: frame {}: {}", file.string(), frame.value, message));
}

// Returns kInput if all fields of view may be radians, of which a half circle has kPi.
Result<void> CheckFovUnit(const ForeignPath& path, const std::filesystem::path& file,
                          const PathOptions& options) {
  if (options.fov_unit || !path.largest_fov || *path.largest_fov >= kPi) return {};
  return InputError(fmt::format(
      "{}: no field of view exceeds {:.4g}, so that the unit is uncertain: in degrees this needs a "
      "very long lens, in radians it is {:.4g} degrees: convert the path, and state the unit of "
      "its "
      "fields of view: {{lfpath fov_unit radians}} or {{lfpath fov_unit degrees}}",
      file.string(), *path.largest_fov, DegreesFromRadians(*path.largest_fov)));
}

Result<double> UnitOf(const ForeignPath& path, const std::filesystem::path& file,
                      const PathOptions& options) {
  const std::optional<double>& of_field = options.light_field_unit_m;
  if (of_field && path.unit_m && std::abs(*path.unit_m - *of_field) > 1e-6 * *of_field)
    return InputError(
        fmt::format("{}: \"lf_unit_m\" is {}, but a world unit of the light field is {} m; remove "
                    "the key, and check the lengths of the path",
                    file.string(), *path.unit_m, *of_field));
  return of_field ? *of_field : path.unit_m.value_or(1);
}

// Returns the focus distance of cameras that state none. Without a range of depths, 1 world unit is
// used, because it is easily recognised as a number that nobody has measured.
double DefaultFocus(const PathOptions& options, ForeignPath* path) {
  double distance_w = 1;
  std::string source;
  if (const auto& range = options.depth_range ? options.depth_range : path->depth_range) {
    // The middle of the inverse depths, because blur is proportional to their differences.
    distance_w = 2 / (1 / range->near_w + 1 / range->far_w);
    source = ", the middle of the scene's depths,";
  }
  path->lacks.push_back(
      distance_w == 1
          ? "no focus distance (1 world unit is used; set {focus_distance})"
          : fmt::format("no focus distance ({:.4g} world units{} are used; set {{focus_distance}})",
                        distance_w, source));
  return distance_w;
}

template <class Member>
bool AllState(const ForeignPath& path, Member member) {
  for (const ForeignCamera& camera : path.cameras)
    if (!(camera.*member)) return false;
  return true;
}

// The values that complete a camera.
struct Defaults {
  double sensor_width_w = 0;
  double focus_distance_w = 0;
};

Defaults DefaultsFor(double unit_m, const PathOptions& options, ForeignPath* path) {
  Defaults defaults;
  defaults.sensor_width_w = kDefaultSensorWidth_mm * (1e-3 / unit_m);
  if (!AllState(*path, &ForeignCamera::aperture_diameter_w) && !options.f_number &&
      !options.aperture_diameter_mm)
    path->lacks.push_back(
        "no aperture (a pinhole is used; set {f_number} or {aperture_diameter_mm})");
  if (!AllState(*path, &ForeignCamera::focus_distance_w))
    defaults.focus_distance_w =
        options.focus_distance_w ? *options.focus_distance_w : DefaultFocus(options, path);
  if (!AllState(*path, &ForeignCamera::sensor_width_w) && !options.sensor_width_mm)
    path->lacks.push_back(fmt::format("no sensor width ({} mm are used; set {{sensor_width_mm}})",
                                      kDefaultSensorWidth_mm));
  return defaults;
}

RenderCamera CameraOf(const ForeignCamera& from, const Defaults& defaults) {
  RenderCamera camera;
  camera.pinhole = from.pinhole;
  const Intrinsics& k = from.pinhole.intrinsics;
  camera.sensor_width_w = from.sensor_width_w.value_or(defaults.sensor_width_w);
  camera.focal_length_w =
      from.focal_length_w.value_or(camera.sensor_width_w * k.fx_px / k.width_px);
  camera.aperture = {from.aperture_diameter_w.value_or(0) / 2, from.blades, from.blade_rotation_rad,
                     from.ratio, from.roundness};
  camera.hood = from.hood;
  camera.focus_distance_w = from.focus_distance_w.value_or(defaults.focus_distance_w);
  camera.focus_tilt = from.focus_tilt;
  camera.focus_plane = FocusPlane(camera.pinhole, camera.focus_distance_w, camera.focus_tilt);
  return camera;
}

// Returns the fault of a camera whose quantities are out of their ranges; "" if there is none.
std::string FaultOf(const RenderCamera& camera) {
  const Intrinsics& k = camera.pinhole.intrinsics;
  const auto is_length = [](double x) { return x > 0 && x <= kLargestLength_w; };
  for (const double f_px : {k.fx_px, k.fy_px}) {
    const double half_view = k.width_px / (2 * f_px);
    if (!(half_view >= kLeastHalfView && half_view <= kMostHalfView))
      return fmt::format("the field of view is {:.4g} degrees: expected above 0 and below 180",
                         DegreesFromRadians(2 * std::atan(half_view)));
  }
  if (!is_length(camera.focal_length_w) || !is_length(camera.sensor_width_w))
    return fmt::format(
        "focal length {:g} and sensor width {:g} in world units: expected above 0, "
        "at most {:g}",
        camera.focal_length_w, camera.sensor_width_w, kLargestLength_w);
  if (!is_length(camera.focus_distance_w))
    return fmt::format("the focus distance is {:g} world units: expected above 0, at most {:g}",
                       camera.focus_distance_w, kLargestLength_w);
  if (!(camera.aperture.radius_w >= 0 && 2 * camera.aperture.radius_w <= kLargestLength_w))
    return fmt::format("the aperture is {:g} world units wide: expected 0 to {:g}",
                       2 * camera.aperture.radius_w, kLargestLength_w);
  if (!IsShape(camera) || !(camera.hood.distance_w <= kLargestLength_w) ||
      !(camera.hood.radius_w <= kLargestLength_w))
    return fmt::format(
        "the hood is {:g} world units in front of the lens and {:g} wide, with {} "
        "blades: expected at most {:g}, and at most {} blades",
        camera.hood.distance_w, 2 * camera.hood.radius_w, camera.aperture.blades, kLargestLength_w,
        kMostBladesInHood);
  return "";
}

void TellWhatIsLacking(const std::vector<std::string>& lacks, const std::filesystem::path& file) {
  if (lacks.empty()) return;
  LogWarning(
      "{}: states {}; lfpath has these options, and writes a path that states every quantity",
      file.string(), fmt::join(lacks, ", "));
}

// Keeps the horizontal field of view, and the elements square if they are. The principal point
// keeps its distance from the centre of the plate.
void Resize(const std::array<int, 2>& resolution_px, Intrinsics* k) {
  if (k->width_px == resolution_px[0] && k->height_px == resolution_px[1]) return;
  const double old_height_px = k->height_px;
  const double factor = static_cast<double>(resolution_px[0]) / k->width_px;
  ScaleResolution(factor, k);
  k->cy_px += (resolution_px[1] - factor * old_height_px) / 2;
  k->width_px = resolution_px[0];
  k->height_px = resolution_px[1];
}

void Replace(const PathOptions& options, RenderCamera* camera) {
  if (options.resolution_px) Resize(*options.resolution_px, &camera->pinhole.intrinsics);
  const double world_units_per_mm = 1e-3 / camera->unit_m;
  if (options.sensor_width_mm) {
    const double width_w = *options.sensor_width_mm * world_units_per_mm;
    camera->focal_length_w *= width_w / camera->sensor_width_w;
    camera->sensor_width_w = width_w;
  }
  if (options.aperture_diameter_mm)
    camera->aperture.radius_w = *options.aperture_diameter_mm * world_units_per_mm / 2;
  if (options.f_number) camera->aperture.radius_w = camera->focal_length_w / *options.f_number / 2;
  if (!options.focus_distance_w) return;
  camera->focus_distance_w = *options.focus_distance_w;
  camera->focus_plane = FocusPlane(camera->pinhole, camera->focus_distance_w, camera->focus_tilt);
}

}  // namespace

double FpsOr(const PathOptions& options, ForeignPath* path) {
  if (!options.fps)
    path->lacks.push_back(
        fmt::format("no frames per second ({} are used; set {{fps}})", kDefaultFps));
  return options.fps.value_or(kDefaultFps);
}

std::array<int, 2> ResolutionOr(const PathOptions& options, ForeignPath* path) {
  if (!options.resolution_px)
    path->lacks.push_back(fmt::format("no resolution ({}x{} is used; set {{resolution}})",
                                      kDefaultResolution_px[0], kDefaultResolution_px[1]));
  return options.resolution_px.value_or(kDefaultResolution_px);
}

Intrinsics IntrinsicsOfFov(double fov_deg, const std::array<int, 2>& resolution_px) {
  const double f_px = resolution_px[1] / (2 * std::tan(RadiansFromDegrees(fov_deg) / 2));
  return {f_px,
          f_px,
          resolution_px[0] / 2.0,
          resolution_px[1] / 2.0,
          0,
          resolution_px[0],
          resolution_px[1]};
}

Intrinsics IntrinsicsOfLens(const PathOptions& options, const std::array<int, 2>& resolution_px,
                            ForeignPath* path) {
  constexpr double kDefaultFocalLength_mm = 50;
  if (!options.focal_length_mm)
    path->lacks.push_back(
        fmt::format("no field of view (that of a lens of {} mm is used; set {{focal_length_mm}})",
                    kDefaultFocalLength_mm));
  Intrinsics k = IntrinsicsOfFov(90, resolution_px);
  k.fx_px = k.fy_px = resolution_px[0] * options.focal_length_mm.value_or(kDefaultFocalLength_mm) /
                      options.sensor_width_mm.value_or(kDefaultSensorWidth_mm);
  return k;
}

NumberRule FovRule(const PathOptions& options) {
  constexpr NumberRule kDegrees = {"the vertical field of view in degrees, above 0 and below 180",
                                   [](double x) { return x > 0 && x < 180; }};
  constexpr NumberRule kRadians = {"the vertical field of view in radians, above 0 and below pi",
                                   [](double x) { return x > 0 && x < kPi; }};
  return options.fov_unit == FovUnit::kRadians ? kRadians : kDegrees;
}

double FovDeg(double stated, const PathOptions& options, ForeignPath* path) {
  path->largest_fov = std::max(path->largest_fov.value_or(stated), stated);
  return options.fov_unit == FovUnit::kRadians ? DegreesFromRadians(stated) : stated;
}

std::optional<FovUnit> FovUnitOf(std::string_view name) {
  if (name == "degrees") return FovUnit::kDegrees;
  if (name == "radians") return FovUnit::kRadians;
  return std::nullopt;
}

double VerticalFov_deg(const Intrinsics& k) {
  return DegreesFromRadians(2 * std::atan(k.height_px / (2 * k.fy_px)));
}

Result<int> ViewsOfKey(const JsonFields& top) {
  constexpr NumberRule kViews = {"the number of views of each moment, from 1 to 1e6", [](double x) {
                                   return x >= 1 && x <= kMostViews && x == std::floor(x);
                                 }};
  LF_ASSIGN_OR_RETURN(const std::optional<double> views, top.Number("lf_views", kViews));
  return static_cast<int>(views.value_or(1));
}

Result<uint32_t> FirstFrameOfKey(const JsonFields& top) {
  constexpr NumberRule kFirst = {
      "the number of the first frame, a whole number from 0 to 99999999",
      [](double x) { return x >= 0 && x <= kLargestFrameNumber && x == std::floor(x); }};
  LF_ASSIGN_OR_RETURN(const std::optional<double> first, top.Number("lf_first_frame", kFirst));
  return static_cast<uint32_t>(first.value_or(1));
}

void MoveInto(const Similarity& b_from_a, ForeignCamera* camera) {
  camera->pinhole.cam_from_world = PoseIn(b_from_a, camera->pinhole.cam_from_world);
  for (std::optional<double>* length : {&camera->sensor_width_w, &camera->focal_length_w,
                                        &camera->aperture_diameter_w, &camera->focus_distance_w})
    if (*length) **length *= b_from_a.scale;
  camera->hood.distance_w *= b_from_a.scale;
  camera->hood.radius_w *= b_from_a.scale;
}

Result<CameraPath> CompletePath(ForeignPath&& path, const std::filesystem::path& file,
                                const PathOptions& options) {
  LF_CHECK(!path.cameras.empty());
  CameraPath complete;
  complete.fps = path.fps;
  complete.views = path.views;
  if (path.cameras.size() % static_cast<size_t>(path.views) != 0)
    return InputError(fmt::format(
        "{}: \"lf_views\" is {}, but the file has {} frames: expected the same number of views of "
        "every moment",
        file.string(), path.views, path.cameras.size()));
  complete.first_frame = path.first_frame;
  if (path.first_frame + path.cameras.size() - 1 > kLargestFrameNumber)
    return InputError(
        fmt::format("{}: \"lf_first_frame\" is {}, so that the last of {} frames has a number "
                    "above {}: state a "
                    "smaller one",
                    file.string(), path.first_frame, path.cameras.size(), kLargestFrameNumber));
  LF_RETURN_IF_ERROR(CheckFovUnit(path, file, options));
  LF_ASSIGN_OR_RETURN(complete.unit_m, UnitOf(path, file, options));
  const Defaults defaults = DefaultsFor(complete.unit_m, options, &path);
  complete.cameras.reserve(path.cameras.size());
  for (size_t i = 0; i < path.cameras.size(); ++i) {
    RenderCamera camera = CameraOf(path.cameras[i], defaults);
    camera.time_s = static_cast<double>(i) / path.fps;
    camera.unit_m = complete.unit_m;
    if (const std::string fault = FaultOf(camera); !fault.empty())
      return FrameError(file, {path.first_frame + static_cast<uint32_t>(i)}, fault);
    complete.cameras.push_back(camera);
  }
  TellWhatIsLacking(path.lacks, file);
  return complete;
}

Result<void> ReplaceQuantities(const PathOptions& options, const std::filesystem::path& file,
                               CameraPath* path) {
  if (options.f_number && options.aperture_diameter_mm)
    return UsageError(
        "{f_number} and {aperture_diameter_mm} state the same quantity: leave one of them out");
  const auto replace = [&](size_t index, RenderCamera* camera) -> Result<void> {
    Replace(options, camera);
    const std::string fault = FaultOf(*camera);
    return fault.empty() ? Result<void>() : FrameError(file, path->frames().At(index), fault);
  };
  for (size_t i = 0; i < path->cameras.size(); ++i)
    LF_RETURN_IF_ERROR(replace(i, &path->cameras[i]));
  for (size_t i = 0; i < path->instants.size(); ++i)
    LF_RETURN_IF_ERROR(replace(i / path->shutter.samples, &path->instants[i]));
  return {};
}

}  // namespace lf
