// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/path/evaluate_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "lf/camera/path/orientation.h"
#include "lf/camera/thin_lens.h"

namespace lf {
namespace {

// Limits of the tangent of half the horizontal field of view. A file with values beyond them is
// considered wrong.
constexpr double kLeastHalfView = 1e-6;
constexpr double kMostHalfView = 1e4;

// A time at which the path is evaluated.
struct Moment {
  const PathDescription& path;
  int frame = 1;
  double time_s = 0;
};

Error ErrorAt(const Moment& moment, const Quantity& quantity, const std::string& message) {
  return InputError(fmt::format("{}:{}:{}: {} at frame {} ({:.4g} s): {}", moment.path.file_name,
                                quantity.place.line, quantity.place.column, quantity.label,
                                moment.frame, moment.time_s, message));
}

// Returns the quantity's value; an error if the value is outside the quantity's range.
Result<MotionValue> ValueOf(const Moment& moment, const Quantity& quantity) {
  const MotionValue value = ValueAt(quantity.motion, moment.time_s);
  for (const double component : value) {
    const double in_file = component / quantity.units_per_file;
    if (!quantity.range.Holds(in_file))
      return ErrorAt(
          moment, quantity,
          fmt::format("{:.6g} must be {}; change its start value, keyframes or accelerations",
                      in_file, quantity.range.Describe()));
  }
  return value;
}

Result<double> NumberOf(const Moment& moment, const Quantity& quantity) {
  LF_ASSIGN_OR_RETURN(const MotionValue value, ValueOf(moment, quantity));
  return value[0];
}

Eigen::Quaterniond OrientationFrom(const MotionValue& value) {
  if (value.size() == 3) return WorldFromCam(value[0], value[1], value[2]);
  return {value[0], value[1], value[2], value[3]};
}

// Returns the pose of a camera at `centre_w` that looks at the point look_at or, if
// path.keep_direction is true, in the direction from its position at time 0 to that point.
Result<RigidTransform> PoseTowards(const Moment& moment, const Vec3& centre_w) {
  const PathDescription& path = moment.path;
  Vec3 from_w = centre_w;
  if (path.keep_direction) from_w = ValueAt(path.position_w.motion, 0);
  LF_ASSIGN_OR_RETURN(const Vec3 target_w, ValueOf(moment, *path.look_at_w));
  const Vec3 forward_w = target_w - from_w;
  if (!(forward_w.norm() > 1e-12 * (target_w.norm() + from_w.norm())))
    return ErrorAt(moment, *path.look_at_w,
                   "the camera is at the point that it looks at; move one of them");
  const auto pose = LookAlong(centre_w, forward_w, path.up);
  if (!pose)
    return ErrorAt(
        moment, *path.look_at_w,
        "the camera looks along 'up', so that it has no upper side; choose another 'up'");
  return *pose;
}

Result<RigidTransform> PoseAt(const Moment& moment) {
  const PathDescription& path = moment.path;
  LF_ASSIGN_OR_RETURN(const Vec3 centre_w, ValueOf(moment, path.position_w));
  LF_ASSIGN_OR_RETURN(const double roll_rad, NumberOf(moment, path.roll_rad));
  RigidTransform pose;
  if (path.look_at_w) {
    LF_ASSIGN_OR_RETURN(pose, PoseTowards(moment, centre_w));
  } else {
    LF_ASSIGN_OR_RETURN(const MotionValue orientation, ValueOf(moment, *path.orientation));
    pose = CamFromWorld(OrientationFrom(orientation), centre_w);
  }
  return Rolled(pose, roll_rad);
}

// Sets focal length f and sensor width, using tan(view / 2) = width / (2 f) for the horizontal
// field of view.
Result<void> SetOptics(const Moment& moment, RenderCamera* camera) {
  const PathDescription& path = moment.path;
  double half_view = 0;  // tangent of half the horizontal field of view; 0 if the path has none
  if (path.field_of_view_rad) {
    LF_ASSIGN_OR_RETURN(const double view_rad, NumberOf(moment, *path.field_of_view_rad));
    half_view = std::tan(view_rad / 2);
  }
  if (path.focal_length_w) {
    LF_ASSIGN_OR_RETURN(camera->focal_length_w, NumberOf(moment, *path.focal_length_w));
  } else {
    camera->focal_length_w = *path.sensor_width_w / (2 * half_view);
  }
  camera->sensor_width_w = path.sensor_width_w.value_or(2 * half_view * camera->focal_length_w);
  return {};
}

// Returns the focus distance g for which the tilted focus plane contains a point at depth z, x to
// the right of the optical axis and u above it:
//   z = g + x tan(horizontal) + u tan(vertical)
double DistanceThrough(const Vec3& point_camera, const FocusTilt& tilt) {
  return point_camera.z() - point_camera.x() * std::tan(tilt.horizontal_rad) +
         point_camera.y() * std::tan(tilt.vertical_rad);
}

Result<void> SetFocus(const Moment& moment, RenderCamera* camera) {
  const PathDescription& path = moment.path;
  LF_ASSIGN_OR_RETURN(const MotionValue tilt, ValueOf(moment, path.focus_tilt_rad));
  camera->focus_tilt = {tilt[0], tilt[1]};
  if (path.focus_distance_w) {
    LF_ASSIGN_OR_RETURN(camera->focus_distance_w, NumberOf(moment, *path.focus_distance_w));
  } else {
    LF_ASSIGN_OR_RETURN(const Vec3 point_w, ValueOf(moment, *path.focus_point_w));
    const Vec3 point_camera = camera->pinhole.cam_from_world * point_w;
    camera->focus_distance_w = DistanceThrough(point_camera, camera->focus_tilt);
    if (!(point_camera.z() > 0) || !(camera->focus_distance_w > 0))
      return ErrorAt(moment, *path.focus_point_w,
                     fmt::format("this point is {:.6g} world units in front of the lens, and the "
                                 "focus plane through it meets the optical axis at {:.6g}: both "
                                 "must be above 0; move the point or the camera",
                                 point_camera.z(), camera->focus_distance_w));
  }
  camera->focus_plane = FocusPlane(camera->pinhole, camera->focus_distance_w, camera->focus_tilt);
  return {};
}

// Sets the intrinsics of a plate at the image distance b behind the lens. b equals the focal length
// unless the lens breathes.
Result<void> SetIntrinsics(const Moment& moment, RenderCamera* camera) {
  const PathDescription& path = moment.path;
  const Quantity& source = path.focal_length_w ? *path.focal_length_w : *path.field_of_view_rad;
  double image_distance_w = camera->focal_length_w;
  if (path.breathing) {
    const auto distance_w = ImageDistance(camera->focal_length_w, camera->focus_distance_w);
    if (!distance_w)
      return ErrorAt(moment, source, distance_w.error().message + " (lens.breathing is true)");
    image_distance_w = *distance_w;
  }
  const double half_view = camera->sensor_width_w / (2 * image_distance_w);
  if (!(half_view >= kLeastHalfView && half_view <= kMostHalfView))
    return ErrorAt(moment, source,
                   fmt::format("focal length {:.4g} and sensor width {:.4g} world units give a "
                               "field of view of {:.4g} degrees; check their units",
                               camera->focal_length_w, camera->sensor_width_w,
                               DegreesFromRadians(2 * std::atan(half_view))));
  const double f_px = path.width_px / (2 * half_view);
  LF_ASSIGN_OR_RETURN(const MotionValue shift_w, ValueOf(moment, path.shift_w));
  const double px_per_w = path.width_px / camera->sensor_width_w;
  camera->pinhole.intrinsics = {f_px,
                                f_px,
                                path.width_px / 2.0 - shift_w[0] * px_per_w,
                                path.height_px / 2.0 + shift_w[1] * px_per_w,
                                0,
                                path.width_px,
                                path.height_px};
  return {};
}

Result<double> ApertureDiameterAt(const Moment& moment, double focal_length_w) {
  const PathDescription& path = moment.path;
  if (path.aperture_diameter_w) return NumberOf(moment, *path.aperture_diameter_w);
  LF_ASSIGN_OR_RETURN(const double f_number, NumberOf(moment, *path.f_number));
  const double diameter_w = focal_length_w / f_number;
  if (!(diameter_w <= NumberRange::kLargest))
    return ErrorAt(
        moment, *path.f_number,
        fmt::format(
            "{:.4g} makes a lens {:.4g} world units wide, more than {:g}; give a larger f-number",
            f_number, diameter_w, NumberRange::kLargest));
  return diameter_w;
}

Result<RenderCamera> CameraAt(const Moment& moment) {
  const PathDescription& path = moment.path;
  RenderCamera camera;
  camera.time_s = moment.time_s;
  camera.unit_m = path.unit_m;
  LF_ASSIGN_OR_RETURN(camera.pinhole.cam_from_world, PoseAt(moment));
  LF_RETURN_IF_ERROR(SetOptics(moment, &camera));
  LF_RETURN_IF_ERROR(SetFocus(moment, &camera));
  LF_RETURN_IF_ERROR(SetIntrinsics(moment, &camera));
  LF_ASSIGN_OR_RETURN(const double diameter_w, ApertureDiameterAt(moment, camera.focal_length_w));
  LF_ASSIGN_OR_RETURN(const double rotation_rad, NumberOf(moment, path.blade_rotation_rad));
  camera.aperture = {diameter_w / 2, path.blades, rotation_rad, path.ratio, path.roundness};
  camera.hood = {path.hood_distance_w, path.hood_diameter_w / 2};
  camera.transmission = path.transmission;
  return camera;
}

// Rotates the blades while they close: by a constant angle per stop below the widest opening among
// the path's frames, stops = 2 log2(widest / diameter). An aperture of diameter 0 has no shape to
// rotate.
void TurnClosingBlades(double rotation_per_stop_rad, CameraPath* path) {
  double widest_w = 0;
  for (const RenderCamera& camera : path->cameras)
    widest_w = std::max(widest_w, camera.aperture.radius_w);
  const auto turn = [&](RenderCamera* camera) {
    if (camera->aperture.radius_w > 0 && widest_w > 0)
      camera->aperture.rotation_rad +=
          rotation_per_stop_rad * 2 * std::log2(widest_w / camera->aperture.radius_w);
  };
  for (RenderCamera& camera : path->cameras) turn(&camera);
  for (RenderCamera& camera : path->instants) turn(&camera);
}

// Evaluates the instants of all frames, unless there is no shutter.
Result<void> AddInstants(const PathDescription& path, CameraPath* evaluated) {
  if (!path.shutter.exists()) return {};
  evaluated->shutter = path.shutter;
  evaluated->instants.reserve(static_cast<size_t>(path.frame_count) * path.shutter.samples);
  for (int frame = 1; frame <= path.frame_count; ++frame)
    for (int k = 0; k < path.shutter.samples; ++k) {
      const double time_s = (frame - 1 + InstantOffset(path.shutter, k)) / path.fps;
      LF_ASSIGN_OR_RETURN(RenderCamera camera, CameraAt({path, frame, time_s}));
      evaluated->instants.push_back(camera);
    }
  return {};
}

}  // namespace

Result<CameraPath> EvaluatePath(const PathDescription& path) {
  CameraPath evaluated;
  evaluated.fps = path.fps;
  evaluated.unit_m = path.unit_m;
  evaluated.focal_surface = path.focal_surface;
  evaluated.cameras.reserve(static_cast<size_t>(path.frame_count));
  for (int frame = 1; frame <= path.frame_count; ++frame) {
    LF_ASSIGN_OR_RETURN(RenderCamera camera, CameraAt({path, frame, (frame - 1) / path.fps}));
    evaluated.cameras.push_back(camera);
  }
  LF_RETURN_IF_ERROR(AddInstants(path, &evaluated));
  TurnClosingBlades(path.blade_rotation_per_stop_rad, &evaluated);
  return evaluated;
}

}  // namespace lf
