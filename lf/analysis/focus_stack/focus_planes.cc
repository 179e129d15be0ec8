// SPDX-License-Identifier: Apache-2.0
#include "lf/analysis/focus_stack/focus_planes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "lf/camera/thin_lens.h"
#include "lf/core/log.h"
#include "lf/core/parse_number.h"
#include "lf/focus/swept_depths.h"
#include "lf/storage/load/open_store.h"

namespace lf {
namespace {

// Returns the image distance b by which the field of view of the camera follows from the width of
// its sensor.
double ImageDistanceOf(const RenderCamera& camera) {
  return camera.pinhole.intrinsics.fx_px * camera.sensor_width_w /
         camera.pinhole.intrinsics.width_px;
}

// Returns true if the field of view depends on the focus distance.
bool Breathes(const RenderCamera& camera) {
  constexpr double kTolerance = 1e-9;
  const double b_w = ImageDistanceOf(camera), f_w = camera.focal_length_w;
  if (std::abs(b_w - f_w) <= kTolerance * f_w) return false;
  const Result<double> focused_w = ImageDistance(f_w, camera.focus_distance_w);
  return focused_w && std::abs(b_w - *focused_w) <= kTolerance * *focused_w;
}

// Sets the field of view of a lens that breathes, by the same steps as EvaluatePath(), so that the
// bits are the same.
Result<void> Breathe(RenderCamera* camera) {
  LF_ASSIGN_OR_RETURN(const double image_distance_w,
                      ImageDistance(camera->focal_length_w, camera->focus_distance_w));
  Intrinsics& k = camera->pinhole.intrinsics;
  const double half_view = camera->sensor_width_w / (2 * image_distance_w);
  const double aspect = k.fy_px / k.fx_px;
  k.fx_px = k.width_px / (2 * half_view);
  k.fy_px = aspect == 1 ? k.fx_px : aspect * k.fx_px;
  return {};
}

Error BadDistance(std::string_view what, std::string_view text) {
  return UsageError(
      fmt::format("{} {}: expected a distance from {:g} to {:g} world units, such as 0.4, or in "
                  "millimetres, such as 400mm",
                  what, text, kLeastFocusDistance_w, kMostFocusDistance_w));
}

bool IsSeparator(char c) { return c == ' ' || c == '\t' || c == ',' || c == '\r'; }

// Returns the depths, along the axis of `camera`, of the corners and the middle of what the LF
// camera sees at a depth.
DepthRange DepthsFrom(const RenderCamera& camera, const PinholeCamera& lf_camera, double depth_w) {
  const Intrinsics& k = lf_camera.intrinsics;
  const PinholeCamera ideal = {
      {k.fx_px, k.fy_px, k.cx_px, k.cy_px, k.skew_px, k.width_px, k.height_px},
      lf_camera.cam_from_world};
  DepthRange range = {INFINITY, -INFINITY};
  for (const Vec2& share : {Vec2(0, 0), Vec2(1, 0), Vec2(0, 1), Vec2(1, 1), Vec2(0.5, 0.5)}) {
    const Vec3 point_world =
        RayOfPixel(ideal, share.x() * k.width_px, share.y() * k.height_px).At(depth_w);
    const double z_w = (camera.pinhole.cam_from_world * point_world).z();
    range = {std::min(range.near_w, z_w), std::max(range.far_w, z_w)};
  }
  return range;
}

}  // namespace

std::vector<double> EvenFocusDistances(const DepthRange& range, size_t count) {
  const double near_per_w = 1 / range.near_w, far_per_w = 1 / range.far_w;
  if (count == 1) return {2 / (near_per_w + far_per_w)};
  std::vector<double> distances_w(count);
  for (size_t i = 0; i < count; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(count - 1);
    distances_w[i] = 1 / (near_per_w + share * (far_per_w - near_per_w));
  }
  // The ends are exact, so that a stack contains the distances that were asked for.
  if (count > 0) {
    distances_w.front() = range.near_w;
    distances_w.back() = range.far_w;
  }
  return distances_w;
}

Result<double> ParseFocusDistance(std::string_view text, std::string_view what, double unit_m) {
  std::string_view number = text;
  double w_per_unit = 1;
  if (number.ends_with("mm")) {
    number.remove_suffix(2);
    w_per_unit = 1e-3 / unit_m;
  }
  const std::optional<double> value = ParseNumber(number);
  const double distance_w = value.value_or(0) * w_per_unit;
  if (!value || !(distance_w >= kLeastFocusDistance_w && distance_w <= kMostFocusDistance_w))
    return BadDistance(what, text);
  return distance_w;
}

Result<std::vector<double>> ParseFocusDistances(std::string_view text, std::string_view what,
                                                double unit_m) {
  std::vector<double> distances_w;
  const bool has_lines = text.find('\n') != std::string_view::npos;
  for (size_t line_number = 1; !text.empty(); ++line_number) {
    std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    line = line.substr(0, line.find('#'));
    const std::string place =
        has_lines ? fmt::format("{}:{}:", what, line_number) : std::string(what);
    while (true) {
      while (!line.empty() && IsSeparator(line.front())) line.remove_prefix(1);
      if (line.empty()) break;
      const auto end = std::find_if(line.begin(), line.end(), IsSeparator);
      const std::string_view word = line.substr(0, static_cast<size_t>(end - line.begin()));
      LF_ASSIGN_OR_RETURN(const double distance_w, ParseFocusDistance(word, place, unit_m));
      distances_w.push_back(distance_w);
      if (distances_w.size() > kMostFocusPlanes)
        return UsageError(
            fmt::format("{}: more than {} distances are given", place, kMostFocusPlanes));
      line.remove_prefix(word.size());
    }
  }
  if (distances_w.empty())
    return UsageError(fmt::format(
        "{}: no distance is given, expected distances such as 0.4,0.5 or 400mm,500mm", what));
  return distances_w;
}

Result<RenderCamera> FocusedAt(const RenderCamera& camera, double focus_distance_w) {
  if (camera.surface)
    return UsageError(
        "the camera is in focus on a focal surface, which has no focus distance to change: give a "
        "camera that is in focus on a plane");
  RenderCamera focused = camera;
  const bool breathes = Breathes(camera);
  focused.focus_distance_w = focus_distance_w;
  focused.focus_plane = FocusPlane(focused.pinhole, focus_distance_w, focused.focus_tilt);
  if (breathes) LF_RETURN_IF_ERROR(Breathe(&focused));
  return focused;
}

Result<CameraPath> FocusStackPath(const CameraPath& path, FrameId frame,
                                  std::span<const double> distances_w) {
  CameraPath stack;
  stack.fps = path.fps;
  stack.unit_m = path.unit_m;
  stack.cameras.reserve(distances_w.size());
  const auto focused = [&](const RenderCamera& camera, double distance_w) -> Result<RenderCamera> {
    Result<RenderCamera> at_distance = FocusedAt(camera, distance_w);
    if (at_distance || at_distance.error().kind == ErrorKind::kUsage) return at_distance;
    return Error{at_distance.error().kind,
                 fmt::format("focus distance {:.6g}: {} (the lens of frame {} breathes)",
                             distance_w, at_distance.error().message, frame.value)};
  };
  for (const double distance_w : distances_w) {
    LF_ASSIGN_OR_RETURN(const RenderCamera camera, focused(path.Camera(frame), distance_w));
    stack.cameras.push_back(camera);
    if (!path.shutter.exists()) continue;
    for (const RenderCamera& instant : path.Instants(frame)) {
      LF_ASSIGN_OR_RETURN(const RenderCamera exposed, focused(instant, distance_w));
      stack.instants.push_back(exposed);
    }
  }
  stack.shutter = path.shutter;
  return stack;
}

Result<DepthRange> FindFocusRange(const LightField& light_field, const RenderCamera& camera,
                                  ThreadPool& pool, std::string_view advice) {
  const Vec3 centre_world = camera.pinhole.CentreWorld();
  std::optional<DepthRange> depths = light_field.depth_range;
  std::string why;
  const char* source = "stated by the light field";
  if (!depths) {
    LF_ASSIGN_OR_RETURN(const auto store, OpenStore(light_field, Mosaics::kToRgb));
    depths = SweptDepths(light_field, *store, centre_world, pool, &why);
    source = "found by comparing LF images";
  }
  if (!depths || light_field.size() == 0)
    return InputError(
        fmt::format("the depths of the scene are not stated by the light field, and comparing LF "
                    "images did not find them surely{}: state the focus distance yourself{}",
                    why.empty() ? "" : " (" + why + ")", advice));
  const PinholeCamera lf_camera = light_field.Camera(NearestCamera(light_field, centre_world));
  const DepthRange near = DepthsFrom(camera, lf_camera, depths->near_w);
  const DepthRange far = DepthsFrom(camera, lf_camera, depths->far_w);
  const DepthRange range = {std::max(std::min(near.near_w, far.near_w), kLeastFocusDistance_w),
                            std::min(std::max(near.far_w, far.far_w), kMostFocusDistance_w)};
  if (!(range.near_w < range.far_w))
    return InputError(
        fmt::format("the depths of the scene, {:.6g} to {:.6g}, {}, are not in front of the render "
                    "camera: state the focus distance yourself{}",
                    depths->near_w, depths->far_w, source, advice));
  LogDebug("depths of the scene, {}: {:.6g} to {:.6g}; focus distances {:.6g} to {:.6g}", source,
           depths->near_w, depths->far_w, range.near_w, range.far_w);
  return range;
}

}  // namespace lf
