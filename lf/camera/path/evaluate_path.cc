// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/path/evaluate_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "lf/camera/path/orientation.h"
#include "lf/camera/thin_lens.h"

namespace lf {
namespace {

// Limits of the tangent of half the horizontal field of view. A file with values beyond them is
// considered wrong.
constexpr double kLeastHalfView = 1e-6;
constexpr double kMostHalfView = 1e4;
constexpr uint32_t kFramesPerLook = 4096;  // frames that are checked between calls of is_stopped

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
  if (path.recording) camera.recording_time = path.recording->At(moment.time_s);
  return camera;
}

// Returns the radius of the opening at a moment, which is 0 if the path has an error there.
double RadiusAt(const Moment& moment) {
  RenderCamera camera;
  if (!SetOptics(moment, &camera)) return 0;
  const Result<double> diameter_w = ApertureDiameterAt(moment, camera.focal_length_w);
  return diameter_w ? *diameter_w / 2 : 0;
}

// Returns the largest radius of the opening among the frames of the path.
double WidestRadius(const PathDescription& path) {
  const auto moves = [](const std::optional<Quantity>& quantity) {
    return quantity && Moves(quantity->motion);
  };
  const bool is_constant = !moves(path.aperture_diameter_w) && !moves(path.f_number) &&
                           !moves(path.focal_length_w) && !moves(path.field_of_view_rad);
  double widest_w = 0;
  for (int i = 0; i < (is_constant ? 1 : path.frame_count); ++i)
    widest_w = std::max(widest_w, RadiusAt({path, path.first_frame + i, i / path.fps}));
  return widest_w;
}

}  // namespace

PathFrames::PathFrames(PathDescription path) : described_(std::move(path)) {
  if (described_->blade_rotation_per_stop_rad != 0) widest_radius_w_ = WidestRadius(*described_);
  whole_.fps = described_->fps;
  whole_.unit_m = described_->unit_m;
  whole_.shutter = described_->shutter;
  whole_.views = described_->views;
  whole_.first_frame = static_cast<uint32_t>(described_->first_frame);
  whole_.focal_surface = described_->focal_surface;
}

PathFrames::PathFrames(CameraPath path) : whole_(std::move(path)) {}

FrameNumbers PathFrames::frames() const {
  if (!described_) return whole_.frames();
  return {whole_.first_frame, static_cast<size_t>(described_->frame_count)};
}

// Rotates the blades while they close: by a constant angle per stop below the widest opening among
// the path's frames, stops = 2 log2(widest / diameter). An aperture of diameter 0 has no shape to
// rotate.
Result<RenderCamera> PathFrames::CameraAtTime(FrameId frame, double time_s) const {
  const PathDescription& path = *described_;
  LF_ASSIGN_OR_RETURN(RenderCamera camera, CameraAt({path, static_cast<int>(frame.value), time_s}));
  if (camera.aperture.radius_w > 0 && widest_radius_w_ > 0)
    camera.aperture.rotation_rad += path.blade_rotation_per_stop_rad * 2 *
                                    std::log2(widest_radius_w_ / camera.aperture.radius_w);
  return camera;
}

Result<RenderCamera> PathFrames::Camera(FrameId frame) const {
  if (!described_) return whole_.Camera(frame);
  const auto index = static_cast<double>(frames().IndexOf(frame));
  LF_ASSIGN_OR_RETURN(RenderCamera camera, CameraAtTime(frame, index / described_->fps));
  // All views of a moment show one recording time.
  if (described_->recording && described_->views > 1) {
    const size_t moment = frames().IndexOf(frame) / static_cast<size_t>(described_->views);
    camera.recording_time =
        described_->recording->At(static_cast<double>(moment) / described_->fps);
  }
  return camera;
}

Result<RenderCamera> PathFrames::Instant(FrameId frame, int instant) const {
  if (!described_) return whole_.Instants(frame)[static_cast<size_t>(instant)];
  const auto index = static_cast<double>(frames().IndexOf(frame));
  return CameraAtTime(frame,
                      (index + InstantOffset(described_->shutter, instant)) / described_->fps);
}

Result<CameraPath> PathFrames::Some(FrameId begin, size_t count) const {
  CameraPath some;
  some.fps = whole_.fps;
  some.unit_m = whole_.unit_m;
  some.shutter = whole_.shutter;
  some.focal_surface = whole_.focal_surface;
  some.first_frame = begin.value;
  // A part of the frames may end within a moment.
  if (count == frame_count()) some.views = whole_.views;
  some.cameras.reserve(count);
  const auto frame_of = [&](size_t i) { return FrameId{begin.value + static_cast<uint32_t>(i)}; };
  for (size_t i = 0; i < count; ++i) {
    LF_ASSIGN_OR_RETURN(RenderCamera camera, Camera(frame_of(i)));
    some.cameras.push_back(std::move(camera));
  }
  if (!some.shutter.exists()) return some;
  some.instants.reserve(count * static_cast<size_t>(some.shutter.samples));
  for (size_t i = 0; i < count; ++i)
    for (int k = 0; k < some.shutter.samples; ++k) {
      LF_ASSIGN_OR_RETURN(RenderCamera camera, Instant(frame_of(i), k));
      some.instants.push_back(std::move(camera));
    }
  return some;
}

Result<void> PathFrames::CheckAll(const std::function<bool()>& is_stopped,
                                  const std::function<Result<void>(FrameId)>& check) const {
  for (size_t i = 0; i < frame_count(); ++i) {
    if (is_stopped && i % kFramesPerLook == kFramesPerLook - 1 && is_stopped())
      return Error{ErrorKind::kInterrupted, "interrupted"};
    LF_RETURN_IF_ERROR(check(frames().At(i)));
  }
  return {};
}

// Looks at the frames in the order of Some(), which therefore finds the same error first.
Result<void> PathFrames::Check(const std::function<bool()>& is_stopped) const {
  if (!described_) return {};
  const auto check_camera = [&](FrameId frame) -> Result<void> {
    const Result<RenderCamera> camera = Camera(frame);
    return camera ? Result<void>() : camera.error();
  };
  LF_RETURN_IF_ERROR(CheckAll(is_stopped, check_camera));
  if (!whole_.shutter.exists()) return {};
  return CheckAll(is_stopped, [&](FrameId frame) -> Result<void> {
    for (int k = 0; k < whole_.shutter.samples; ++k) LF_RETURN_IF_ERROR(Instant(frame, k));
    return {};
  });
}

Result<CameraPath> EvaluatePath(const PathFrames& path) {
  return path.Some(FrameId{path.frames().first}, path.frame_count());
}

}  // namespace lf
