// SPDX-License-Identifier: Apache-2.0
#include "lf/selection/seen_region.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lf {
namespace {

// The margins of lens and plate are 10 and 1000 times as large as those of overlap.cc.
constexpr double kLensGrowth = 1 + 1e-5;
constexpr double kPlateMargin_px = 1e-3;
constexpr double kRounding = 1e-9;

std::array<Vec3, 8> Corners(const WorldBox& box) {
  std::array<Vec3, 8> corners;
  for (int i = 0; i < 8; ++i)
    corners[i] = {(i & 1) != 0 ? box.high[0] : box.low[0], (i & 2) != 0 ? box.high[1] : box.low[1],
                  (i & 4) != 0 ? box.high[2] : box.low[2]};
  return corners;
}

}  // namespace

SeenRegion::SeenRegion(const RenderCamera& frame)
    : centre_(frame.pinhole.CentreWorld()),
      right_(frame.pinhole.RightWorld()),
      up_(frame.pinhole.UpWorld()),
      forward_(frame.pinhole.ForwardWorld()),
      radius_w_(frame.aperture.radius_w * kLensGrowth * kDiskPolygonRadius) {
  const Intrinsics& k = frame.pinhole.intrinsics;
  const Mat3 to_camera = k.InverseMatrix();
  const double height = frame.focus_plane.offset_w - frame.focus_plane.normal.dot(centre_);
  // t is the vector (right, up) from the lens centre to a focus point, divided by the depth of this
  // point, and q is 1 / depth (seen_region.h). Both are linear in the position on the plate, so
  // that their bounds are at the corners of the plate.
  Vec2 t_low = Vec2::Constant(INFINITY), t_high = -t_low;
  q_low_ = INFINITY;
  q_high_ = -INFINITY;
  for (const double y : {-kPlateMargin_px, k.height_px + kPlateMargin_px})
    for (const double x : {-kPlateMargin_px, k.width_px + kPlateMargin_px}) {
      const Vec3 p = to_camera * Vec3(x, y, 1);
      const Vec2 t(p.x() / p.z(), -p.y() / p.z());
      t_low = t_low.cwiseMin(t);
      t_high = t_high.cwiseMax(t);
      const Vec3 direction = right_ * t.x() + up_ * t.y() + forward_;
      if (frame.surface) continue;
      const double q = frame.focus_plane.normal.dot(direction) / height;
      q_low_ = std::min(q_low_, q);
      q_high_ = std::max(q_high_, q);
    }
  if (frame.surface)
    for (const FocalBlock& block : frame.surface->blocks()) {
      q_low_ = std::min(q_low_, block.q_low);
      q_high_ = std::max(q_high_, block.q_high);
    }
  if (!std::isfinite(q_low_) || !std::isfinite(q_high_)) {
    is_everything_ = true;
    ray_angle_rad_ = kPi;
    return;
  }
  // Elements with q = 1 / depth <= 0 have no focus point in front of the lens: they see beyond the
  // horizon of a tilted focus plane.
  is_empty_ = q_high_ <= 0;
  q_low_ = std::max(0.0, q_low_ * (1 - kRounding));
  q_high_ *= 1 + kRounding;
  const double bounds[4][2] = {{t_high.x(), t_low.x()},
                               {-t_low.x(), -t_high.x()},
                               {t_high.y(), t_low.y()},
                               {-t_low.y(), -t_high.y()}};
  for (int side = 0; side < 4; ++side) {
    slope_[side] = bounds[side][0];
    other_slope_[side] = bounds[side][1];
  }
  // Largest right and up components, per unit of depth, of a ray from the lens to a focus point.
  const Vec2 steepest =
      t_low.cwiseAbs().cwiseMax(t_high.cwiseAbs()) + Vec2::Constant(radius_w_ * q_high_);
  ray_angle_rad_ = std::atan(steepest.norm()) + kRounding;
}

Vec3 SeenRegion::InLensAxes(const Vec3& world) const {
  const Vec3 offset = world - centre_;
  return {right_.dot(offset), up_.dot(offset), forward_.dot(offset)};
}

double SeenRegion::Beyond(int side, const Vec3& place) const {
  const double z = place.z();
  const double along = std::max(z * slope_[side], z * other_slope_[side]);
  const double lens = radius_w_ * std::max(std::abs(1 - z * q_low_), std::abs(1 - z * q_high_));
  const double at = side < 2 ? place.x() : place.y();
  const double magnitude = std::abs(place.x()) + std::abs(place.y()) + std::abs(z) + lens;
  return (side % 2 == 0 ? at : -at) - along - lens - kRounding * magnitude;
}

bool SeenRegion::Misses(const Vec3& centre_world) const {
  if (is_everything_) return false;
  if (is_empty_) return true;
  const Vec3 place = InLensAxes(centre_world);
  for (int side = 0; side < 4; ++side)
    if (Beyond(side, place) > 0) return true;
  return false;
}

bool SeenRegion::Misses(const WorldBox& box) const {
  if (is_everything_) return false;
  if (is_empty_) return true;
  bool is_beyond[4] = {true, true, true, true};
  for (const Vec3& corner : Corners(box)) {
    const Vec3 place = InLensAxes(corner);
    for (int side = 0; side < 4; ++side)
      is_beyond[side] = is_beyond[side] && Beyond(side, place) > 0;
  }
  return is_beyond[0] || is_beyond[1] || is_beyond[2] || is_beyond[3];
}

// Tests the box at its two ends in depth, and at the depths in between where a bound has a kink:
// the region is narrowest at one of these depths.
bool SeenRegion::HoldsAll(const WorldBox& box) const {
  if (is_everything_) return true;
  if (is_empty_) return false;
  Vec3 low = Vec3::Constant(INFINITY), high = -low;
  for (const Vec3& corner : Corners(box)) {
    const Vec3 place = InLensAxes(corner);
    low = low.cwiseMin(place);
    high = high.cwiseMax(place);
  }
  for (const double bend : {low.z(), high.z(), 0.0, 2 / (q_low_ + q_high_)}) {
    if (!(low.z() <= bend && bend <= high.z())) continue;
    for (int side = 0; side < 4; ++side) {
      const Vec3& extreme = side % 2 == 0 ? high : low;
      if (Beyond(side, {extreme.x(), extreme.y(), bend}) > 0) return false;
    }
  }
  return true;
}

}  // namespace lf
