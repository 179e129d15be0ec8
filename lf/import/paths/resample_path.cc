// SPDX-License-Identifier: Apache-2.0
#include "lf/import/paths/resample_path.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "lf/camera/path/motion.h"
#include "lf/camera/path/orientation.h"

namespace lf {
namespace {

// Difference of two places, in frames, that are the same but for rounding errors.
constexpr double kSamePlace = 1e-9;
constexpr int kNumbersBetween = 16;  // number of values that NumberBetween() knows

// Returns one of the numbers of a camera that are monotone cubics between frames.
double& NumberBetween(RenderCamera* camera, int index) {
  Intrinsics& k = camera->pinhole.intrinsics;
  double* const numbers[kNumbersBetween] = {&k.fx_px,
                                            &k.fy_px,
                                            &k.cx_px,
                                            &k.cy_px,
                                            &k.skew_px,
                                            &camera->aperture.radius_w,
                                            &camera->aperture.rotation_rad,
                                            &camera->focal_length_w,
                                            &camera->sensor_width_w,
                                            &camera->focus_distance_w,
                                            &camera->focus_tilt.horizontal_rad,
                                            &camera->focus_tilt.vertical_rad,
                                            &camera->aperture.ratio,
                                            &camera->aperture.roundness,
                                            &camera->hood.distance_w,
                                            &camera->hood.radius_w};
  return *numbers[index];
}

using ValueOfCamera = std::function<MotionValue(const RenderCamera&)>;

// Returns the curve through a value of all cameras, whose parameter is the index of the frame.
KeyframeCurve CurveThrough(const CameraPath& path, SmoothCurve curve, const ValueOfCamera& value) {
  std::vector<Key> keys;
  keys.reserve(path.frame_count());
  for (const RenderCamera& camera : path.cameras)
    keys.push_back({static_cast<double>(keys.size()), value(camera), Interpolation::kSmooth});
  return {std::move(keys), curve};
}

class CameraCurves {
 public:
  explicit CameraCurves(const CameraPath& path)
      : path_(path),
        position_(CurveThrough(path, SmoothCurve::kCatmullRom,
                               [](const RenderCamera& camera) -> MotionValue {
                                 return camera.pinhole.CentreWorld();
                               })),
        rotation_(CurveThrough(
            path, SmoothCurve::kRotation, [](const RenderCamera& camera) -> MotionValue {
              const Mat3 world_from_cam = camera.pinhole.cam_from_world.rotation.transpose();
              const Eigen::Quaterniond q(world_from_cam);
              return Eigen::Vector4d(q.w(), q.x(), q.y(), q.z());
            })) {
    for (int i = 0; i < kNumbersBetween; ++i)
      numbers_.push_back(CurveThrough(path, SmoothCurve::kMonotone,
                                      [i](const RenderCamera& camera) -> MotionValue {
                                        RenderCamera copy = camera;
                                        return MotionValue::Constant(1, NumberBetween(&copy, i));
                                      }));
  }

  // Returns the camera at a place from 0 to the index of the last frame.
  RenderCamera At(double place) const {
    const double nearest = std::round(place);
    if (std::abs(place - nearest) <= kSamePlace) return path_.cameras[static_cast<size_t>(nearest)];
    RenderCamera camera = path_.cameras[static_cast<size_t>(place)];  // with its size and blades
    const MotionValue q = rotation_.At(place);
    camera.pinhole.cam_from_world =
        CamFromWorld(Eigen::Quaterniond(q[0], q[1], q[2], q[3]), position_.At(place));
    for (int i = 0; i < kNumbersBetween; ++i)
      NumberBetween(&camera, i) = numbers_[static_cast<size_t>(i)].At(place)[0];
    camera.focus_plane = FocusPlane(camera.pinhole, camera.focus_distance_w, camera.focus_tilt);
    return camera;
  }

 private:
  const CameraPath& path_;
  KeyframeCurve position_, rotation_;
  std::vector<KeyframeCurve> numbers_;
};

}  // namespace

Result<CameraPath> ResamplePath(const CameraPath& path, std::optional<double> fps,
                                std::optional<uint32_t> frame_count) {
  const double last = static_cast<double>(path.frame_count() - 1);  // place of the last camera
  const double new_fps = fps.value_or(path.fps);
  const double count =
      frame_count ? *frame_count : std::floor(last / path.fps * new_fps + kSamePlace) + 1;
  if (!(count <= kMostFrames))
    return UsageError(fmt::format("--fps {} makes {} frames of the path: expected at most {}",
                                  new_fps, count, kMostFrames));
  // Distance of two new frames, in old frames.
  const double step = frame_count ? last / std::max(count - 1, 1.0) : path.fps / new_fps;
  if (path.focal_surface && path.focal_surface->kind == FocalSurfaceSource::Kind::kDepths)
    return InputError(
        "the path has depth pictures as its focal surface, one for each of its frames as they are: "
        "leave --fps and --frames out, use a height map (focus.kind: height), or remove 'focus' "
        "from the path");
  CameraPath resampled;
  resampled.focal_surface = path.focal_surface;
  resampled.fps = new_fps;
  resampled.unit_m = path.unit_m;
  resampled.cameras.reserve(static_cast<size_t>(count));
  const CameraCurves curves(path);
  for (size_t i = 0; i < static_cast<size_t>(count); ++i) {
    RenderCamera camera = curves.At(std::min(static_cast<double>(i) * step, last));
    camera.time_s = static_cast<double>(i) / new_fps;
    resampled.cameras.push_back(camera);
  }
  LF_RETURN_IF_ERROR(AddShutter(path.shutter, &resampled));
  return resampled;
}

Result<void> AddShutter(const Shutter& shutter, CameraPath* path) {
  path->shutter = shutter;
  path->instants.clear();
  if (!shutter.exists()) return {};
  const auto samples = static_cast<size_t>(shutter.samples);
  if (path->frame_count() * samples > kMostInstants)
    return UsageError(
        fmt::format("{} frames with {} samples of the shutter are {} cameras: expected at most {}",
                    path->frame_count(), samples, path->frame_count() * samples, kMostInstants));
  path->instants.reserve(path->frame_count() * samples);
  const CameraCurves curves(*path);
  const double last = static_cast<double>(path->frame_count() - 1);
  for (size_t i = 0; i < path->frame_count(); ++i)
    for (int k = 0; k < shutter.samples; ++k) {
      const double place = static_cast<double>(i) + InstantOffset(shutter, k);
      RenderCamera camera = curves.At(std::clamp(place, 0.0, last));
      camera.time_s = place / path->fps;
      path->instants.push_back(camera);
    }
  return {};
}

}  // namespace lf
