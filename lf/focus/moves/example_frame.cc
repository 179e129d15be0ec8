// SPDX-License-Identifier: Apache-2.0
#include "lf/focus/moves/example_frame.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>

#include "lf/camera/ray_through.h"
#include "lf/light_field/model/capture_geometry.h"

namespace lf {
namespace {

constexpr double kMostRoll_deg = 30;

// Returns the largest even size that is not above `size`, but at least 2, because video needs even
// sizes.
int Even(double size) {
  const int whole = static_cast<int>(std::lround(size));
  return std::max(2, whole - whole % 2);
}

// Searches the largest frame of the proportions of an LF image that the LF camera sees wholly.
class FrameSearch {
 public:
  FrameSearch(const PinholeCamera& camera, const RigidTransform& pose)
      : k_(camera.intrinsics),
        pose_(pose),
        lf_from_world_(camera.cam_from_world.rotation),
        rays_(camera, camera.ForwardWorld()) {}

  // Returns the place of the middle of the LF image in a camera of focal length 1 with the pose of
  // the frames.
  Vec2 MiddleOfImage() const {
    const double y = (k_.height_px / 2.0 - k_.cy_px) / k_.fy_px;
    const double x = (k_.width_px / 2.0 - k_.cx_px - k_.skew_px * y) / k_.fx_px;
    const std::optional<Vec3> direction = rays_.map().Undistort({x, y});
    if (!direction) return Vec2::Zero();
    const Vec3 d = pose_.rotation * (lf_from_world_.transpose() * *direction);
    return d.z() > 0 ? Vec2(d.x() / d.z(), d.y() / d.z()) : Vec2(Vec2::Zero());
  }

  //   middle  the place of the middle of the frame, as MiddleOfImage() returns it
  Intrinsics Largest(const Vec2& middle) const {
    constexpr double kLeastShare = 0.25;
    if (IsSeen(FrameOf(1, middle))) return FrameOf(1, middle);
    double seen = kLeastShare, unseen = 1;
    for (int i = 0; i < 20; ++i) {
      const double share = (seen + unseen) / 2;
      (IsSeen(FrameOf(share, middle)) ? seen : unseen) = share;
    }
    return FrameOf(seen, middle);
  }

 private:
  Intrinsics FrameOf(double share, const Vec2& middle) const {
    const int width = Even(share * k_.width_px), height = Even(share * k_.height_px);
    const double f_px = k_.fx_px;
    return {f_px,  f_px,  width / 2.0 - f_px * middle.x(), height / 2.0 - f_px * middle.y(), 0,
            width, height};
  }

  bool IsSeen(const Intrinsics& frame) const {
    constexpr int kPoints = 16;  // number of steps between the tested points of each side
    constexpr double kTolerance_px = 0.5;
    const PinholeCamera pinhole{frame, pose_};
    for (int i = 0; i <= kPoints; ++i) {
      const double x = frame.width_px * static_cast<double>(i) / kPoints;
      const double y = frame.height_px * static_cast<double>(i) / kPoints;
      const double w = frame.width_px, h = frame.height_px;
      for (const Vec2& at : {Vec2(x, 0), Vec2(x, h), Vec2(0, y), Vec2(w, y)}) {
        const auto place = rays_.RecordedAt(RayOfPixel(pinhole, at.x(), at.y()).direction);
        if (!place || place->x() < -kTolerance_px || place->y() < -kTolerance_px ||
            place->x() > k_.width_px + kTolerance_px || place->y() > k_.height_px + kTolerance_px)
          return false;
      }
    }
    return true;
  }

  Intrinsics k_;
  RigidTransform pose_;
  Mat3 lf_from_world_;
  RayThrough rays_;
};

// Returns the frame with larger elements, so that it is at most kMostFrameWidth_px wide.
Intrinsics AtMostWide(const Intrinsics& frame) {
  if (frame.width_px <= kMostFrameWidth_px) return frame;
  const double scale = double{kMostFrameWidth_px} / frame.width_px;
  const int height = Even(scale * frame.height_px);
  const double f_px = scale * frame.fx_px;
  return {f_px,
          f_px,
          scale * frame.cx_px,
          height / 2.0 + scale * (frame.cy_px - frame.height_px / 2.0),
          0,
          kMostFrameWidth_px,
          height};
}

}  // namespace

Vec3 VerticalWorld(const LightField& light_field) {
  const Vec3 mean = MeanUpWorld(light_field);
  if (mean == Vec3::Zero()) return mean;
  Mat3 rights = Mat3::Zero();
  for (const LfCamera& camera : light_field.cameras) {
    const Vec3 right = camera.cam_from_world.rotation.row(0).transpose();
    rights += right * right.transpose() / static_cast<double>(light_field.size());
  }
  // The squared spread of the right hands along the vertical and across it. Directions that differ
  // by less than ten degrees or so tell the vertical less well than the mean of the up directions.
  const Eigen::SelfAdjointEigenSolver<Mat3> eigen(rights);
  constexpr double kLeastSpread = 0.03, kMostRatio = 0.1, kLeastCosine = 0.7;
  const Vec3 spread = eigen.eigenvalues();
  if (spread[1] < kLeastSpread || spread[0] > kMostRatio * spread[1]) return mean;
  Vec3 vertical = eigen.eigenvectors().col(0);
  if (vertical.dot(mean) < 0) vertical = -vertical;
  return vertical.dot(mean) < kLeastCosine ? mean : vertical;
}

Vec3 LevelUpWorld(const LightField& light_field, const PinholeCamera& camera) {
  const Vec3 up = VerticalWorld(light_field);
  const double roll_rad = RollOf(camera, up);
  if (up == Vec3::Zero() || roll_rad == 0 || roll_rad > RadiansFromDegrees(kMostRoll_deg))
    return camera.UpWorld();
  return up;
}

Intrinsics InscribedFrame(const PinholeCamera& camera, const Vec3& up_world) {
  const Intrinsics& k = camera.intrinsics;
  const std::optional<RigidTransform> pose =
      LookAlong(camera.CentreWorld(), camera.ForwardWorld(), up_world);
  const FrameSearch search(camera, pose ? *pose : camera.cam_from_world);
  const Intrinsics centred = search.Largest(Vec2::Zero());
  constexpr double kSmallLoss = 0.02;
  if (centred.width_px >= (1 - kSmallLoss) * k.width_px) return AtMostWide(centred);
  const Intrinsics shifted = search.Largest(search.MiddleOfImage());
  return AtMostWide(shifted.width_px * (1 - kSmallLoss) > centred.width_px ? shifted : centred);
}

Intrinsics CroppedFrame(const Intrinsics& frame, double share) {
  if (share == 1) return frame;
  const int width = Even(share * frame.width_px), height = Even(share * frame.height_px);
  return {frame.fx_px,
          frame.fy_px,
          frame.cx_px - (frame.width_px - width) / 2.0,
          frame.cy_px - (frame.height_px - height) / 2.0,
          0,
          width,
          height};
}

}  // namespace lf
