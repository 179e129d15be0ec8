// SPDX-License-Identifier: Apache-2.0
#include "lf/import/paths/resample_path.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "lf/camera/path/motion.h"
#include "lf/camera/path/orientation.h"

namespace lf {
namespace {

// Difference of two places, in moments, that are the same but for rounding errors.
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

// Returns the cameras of one view of all moments. If there is one view, these are all cameras.
std::vector<RenderCamera> CamerasOfView(const CameraPath& path, int view) {
  std::vector<RenderCamera> cameras;
  cameras.reserve(path.moment_count());
  for (size_t moment = 0; moment < path.moment_count(); ++moment)
    cameras.push_back(path.cameras[moment * static_cast<size_t>(path.views) + view]);
  return cameras;
}

// Returns the curve through a value of the cameras, whose parameter is their index.
KeyframeCurve CurveThrough(const std::vector<RenderCamera>& cameras, SmoothCurve curve,
                           const ValueOfCamera& value) {
  std::vector<Key> keys;
  keys.reserve(cameras.size());
  for (const RenderCamera& camera : cameras)
    keys.push_back({static_cast<double>(keys.size()), value(camera), Interpolation::kSmooth});
  return {std::move(keys), curve};
}

// The cameras of one view, which move from moment to moment.
class CameraCurves {
 public:
  explicit CameraCurves(std::vector<RenderCamera> cameras)
      : cameras_(std::move(cameras)),
        position_(CurveThrough(cameras_, SmoothCurve::kCatmullRom,
                               [](const RenderCamera& camera) -> MotionValue {
                                 return camera.pinhole.CentreWorld();
                               })),
        rotation_(CurveThrough(
            cameras_, SmoothCurve::kRotation, [](const RenderCamera& camera) -> MotionValue {
              const Mat3 world_from_cam = camera.pinhole.cam_from_world.rotation.transpose();
              const Eigen::Quaterniond q(world_from_cam);
              return Eigen::Vector4d(q.w(), q.x(), q.y(), q.z());
            })) {
    for (int i = 0; i < kNumbersBetween; ++i)
      numbers_.push_back(CurveThrough(cameras_, SmoothCurve::kMonotone,
                                      [i](const RenderCamera& camera) -> MotionValue {
                                        RenderCamera copy = camera;
                                        return MotionValue::Constant(1, NumberBetween(&copy, i));
                                      }));
  }

  // Returns the camera at a place from 0 to the index of the last moment.
  RenderCamera At(double place) const {
    const double nearest = std::round(place);
    if (std::abs(place - nearest) <= kSamePlace) return cameras_[static_cast<size_t>(nearest)];
    RenderCamera camera = cameras_[static_cast<size_t>(place)];  // with its size and blades
    const MotionValue q = rotation_.At(place);
    camera.pinhole.cam_from_world =
        CamFromWorld(Eigen::Quaterniond(q[0], q[1], q[2], q[3]), position_.At(place));
    for (int i = 0; i < kNumbersBetween; ++i)
      NumberBetween(&camera, i) = numbers_[static_cast<size_t>(i)].At(place)[0];
    camera.focus_plane = FocusPlane(camera.pinhole, camera.focus_distance_w, camera.focus_tilt);
    return camera;
  }

 private:
  std::vector<RenderCamera> cameras_;
  KeyframeCurve position_, rotation_;
  std::vector<KeyframeCurve> numbers_;
};

// Returns the recording time between two moments of a path; nullopt if it has none.
std::optional<double> RecordingTimeAt(const CameraPath& path, double moment) {
  const auto views = static_cast<size_t>(path.views);
  const auto before = static_cast<size_t>(moment);
  const size_t after = std::min(before + 1, path.moment_count() - 1);
  const std::optional<double>& a = path.cameras[before * views].recording_time;
  const std::optional<double>& b = path.cameras[after * views].recording_time;
  if (!a || !b) return std::nullopt;
  return *a + (moment - static_cast<double>(before)) * (*b - *a);
}

}  // namespace

Result<CameraPath> ResamplePath(const CameraPath& path, std::optional<double> fps,
                                std::optional<uint32_t> frame_count) {
  const double last = static_cast<double>(path.moment_count() - 1);  // place of the last moment
  const double new_fps = fps.value_or(path.fps);
  const auto views = static_cast<uint32_t>(path.views);
  if (frame_count && *frame_count % views != 0)
    return UsageError(fmt::format(
        "{{frames {}}}: the path has {} views of each moment, which are frames of their "
        "own: expected a multiple of {}",
        *frame_count, views, views));
  // Number of new moments.
  const double count =
      frame_count ? *frame_count / views : std::floor(last / path.fps * new_fps + kSamePlace) + 1;
  if (!(count * views <= kMostFrames))
    return UsageError(fmt::format("{{fps {}}} makes {} frames of the path: expected at most {}",
                                  new_fps, count * views, kMostFrames));
  // Distance of two new moments, in old moments.
  const double step = frame_count ? last / std::max(count - 1, 1.0) : path.fps / new_fps;
  if (path.focal_surface && path.focal_surface->kind == FocalSurfaceSource::Kind::kDepths)
    return InputError(
        "the path has depth pictures as its focal surface, one for each of its frames as they are: "
        "leave {fps} and {frames} out, use a height map (focus.kind: height), or remove 'focus' "
        "from the path");
  CameraPath resampled;
  resampled.focal_surface = path.focal_surface;
  resampled.fps = new_fps;
  resampled.unit_m = path.unit_m;
  resampled.views = path.views;
  resampled.first_frame = path.first_frame;
  resampled.cameras.resize(static_cast<size_t>(count) * views);
  for (uint32_t view = 0; view < views; ++view) {
    const CameraCurves curves(CamerasOfView(path, static_cast<int>(view)));
    for (size_t moment = 0; moment < static_cast<size_t>(count); ++moment) {
      const size_t i = moment * views + view;
      resampled.cameras[i] = curves.At(std::min(static_cast<double>(moment) * step, last));
      resampled.cameras[i].time_s = static_cast<double>(i) / new_fps;
      resampled.cameras[i].recording_time =
          RecordingTimeAt(path, std::min(static_cast<double>(moment) * step, last));
    }
  }
  LF_RETURN_IF_ERROR(AddShutter(path.shutter, &resampled));
  return resampled;
}

Result<void> AddShutter(const Shutter& shutter, CameraPath* path) {
  path->shutter = shutter;
  path->instants.clear();
  if (!shutter.exists()) return {};
  if (path->views > 1)
    return UsageError(fmt::format(
        "the path has {} views of each moment, between which no camera moves: leave the "
        "shutter out",
        path->views));
  const auto samples = static_cast<size_t>(shutter.samples);
  if (path->frame_count() * samples > kMostInstants)
    return UsageError(
        fmt::format("{} frames with {} samples of the shutter are {} cameras: expected at most {}",
                    path->frame_count(), samples, path->frame_count() * samples, kMostInstants));
  path->instants.reserve(path->frame_count() * samples);
  const CameraCurves curves(path->cameras);
  const double last = static_cast<double>(path->frame_count() - 1);
  for (size_t i = 0; i < path->frame_count(); ++i)
    for (int k = 0; k < shutter.samples; ++k) {
      const double place = static_cast<double>(i) + InstantOffset(shutter, k);
      RenderCamera camera = curves.At(std::clamp(place, 0.0, last));
      camera.time_s = place / path->fps;
      camera.recording_time = RecordingTimeAt(*path, std::clamp(place, 0.0, last));
      path->instants.push_back(camera);
    }
  return {};
}

}  // namespace lf
