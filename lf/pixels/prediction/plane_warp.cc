// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/prediction/plane_warp.h"

#include <algorithm>
#include <cmath>

#include "lf/core/check.h"

namespace lf {
namespace {

constexpr int64_t kOne = int64_t{1} << kWarpBits;
constexpr int64_t kMostPosition = int64_t{1} << (16 + kPositionBits);

// Returns a / b, rounded to the nearest integer, halves up; b > 0.
int64_t RoundedQuotient(int64_t a, int64_t b) {
  const int64_t sum = a + b / 2, quotient = sum / b;
  return sum % b < 0 ? quotient - 1 : quotient;
}

// Returns the homography for pixel indices of one for continuous coordinates.
Mat3 ForIndices(const Mat3& homography) {
  Mat3 to_centre = Mat3::Identity(), to_index = Mat3::Identity();
  to_centre(0, 2) = to_centre(1, 2) = 0.5;
  to_index(0, 2) = to_index(1, 2) = -0.5;
  return to_index * homography * to_centre;
}

// Sets `number` to the fraction with kWarpBits bits. Returns false if its magnitude exceeds `most`.
bool SetFraction(double value, int64_t most, int64_t* number) {
  const double scaled = std::round(value * static_cast<double>(kOne));
  if (!(std::abs(scaled) <= static_cast<double>(most))) return false;
  *number = static_cast<int64_t>(scaled);
  return true;
}

}  // namespace

PlaneWarp IdentityWarp() {
  PlaneWarp warp;
  for (int i = 0; i < 3; ++i) warp.far[i][i] = kOne;
  return warp;
}

bool IsWithinLimits(const PlaneWarp& warp) {
  const auto is_within = [](int64_t value, int64_t most) {
    return value >= -most && value <= most;
  };
  for (int row = 0; row < 3; ++row)
    if (!is_within(warp.far[row][0], kMostSlope) || !is_within(warp.far[row][1], kMostSlope) ||
        !is_within(warp.far[row][2], kMostOrigin) || !is_within(warp.step[row], kMostStep))
      return false;
  return true;
}

PinholeView Halved(const PinholeView& view) {
  PinholeView halved = view;
  halved.intrinsics.topRows<2>() /= 2;
  return halved;
}

std::optional<PlaneWarp> MakePlaneWarp(const PinholeView& target, const PinholeView& reference,
                                       const InverseDepthRange& depths) {
  const RigidTransform reference_from_target =
      reference.cam_from_world * target.cam_from_world.Inverse();
  const Mat3 target_rays = target.intrinsics.inverse();
  // A plane of inverse depth r consists of the points X with r X_z = 1, and (0 0 1) K^-1 = (0 0 1).
  const auto homography = [&](double inverse_depth) -> Mat3 {
    Mat3 motion = reference_from_target.rotation;
    motion.col(2) += inverse_depth * reference_from_target.translation;
    return ForIndices(reference.intrinsics * motion * target_rays);
  };
  const Mat3 far = homography(depths.least);
  const Vec3 step =
      (homography(depths.greatest).col(2) - far.col(2)) / static_cast<double>(kDepthSteps - 1);
  PlaneWarp warp;
  for (int row = 0; row < 3; ++row)
    if (!SetFraction(far(row, 0), kMostSlope, &warp.far[row][0]) ||
        !SetFraction(far(row, 1), kMostSlope, &warp.far[row][1]) ||
        !SetFraction(far(row, 2), kMostOrigin, &warp.far[row][2]) ||
        !SetFraction(step[row], kMostStep, &warp.step[row]))
      return std::nullopt;
  return warp;
}

WarpedPosition Warped(const PlaneWarp& warp, int depth, int x, int y) {
  LF_DCHECK(depth >= 0 && depth < kDepthSteps);
  const auto row = [&](int i) {
    return warp.far[i][0] * x + warp.far[i][1] * y + warp.far[i][2] + depth * warp.step[i];
  };
  const int64_t w = row(2);
  if (w <= 0) return {x * (1 << kPositionBits), y * (1 << kPositionBits)};
  const auto position = [w](int64_t u) {
    const int64_t exact = RoundedQuotient(u * (1 << kPositionBits), w);
    return static_cast<int32_t>(std::clamp(exact, -kMostPosition, kMostPosition));
  };
  return {position(row(0)), position(row(1))};
}

}  // namespace lf
