// SPDX-License-Identifier: Apache-2.0
#include "lf/live/undistort.h"

#include <algorithm>
#include <cmath>

#include "lf/camera/distortion.h"
#include "lf/collection/gather.h"
#include "lf/core/check.h"

namespace lf {
namespace {

constexpr int kBorderPlaces = 33;  // places on each border at which a lens is looked through
constexpr double kWidest = 1.7320508075688772;  // tangent of 60 degrees
constexpr double kLeastShare = 0.5;

// A rectangle of directions (X / Z, Y / Z).
struct Directions {
  double left = -kWidest, top = -kWidest, right = kWidest, bottom = kWidest;
};

// Makes the rectangle smaller, so that a lens sees all of it.
void Restrict(const Intrinsics& k, Directions* seen) {
  const DistortionMap map(k.distortion);
  const Mat3 inverse = k.InverseMatrix();
  // The outermost positions between four pixel centres.
  const double right_px = k.width_px - 0.5, bottom_px = k.height_px - 0.5, first_px = 0.5;
  const auto direction_at = [&](double x_px, double y_px) -> std::optional<Vec2> {
    const Vec3 distorted = inverse * Vec3(x_px, y_px, 1);
    const std::optional<Vec3> direction = map.Undistort(distorted.head<2>());
    if (!direction || !(direction->z() > 0)) return std::nullopt;
    return Vec2(direction->head<2>() / direction->z());
  };
  for (int i = 0; i < kBorderPlaces; ++i) {
    const double share = static_cast<double>(i) / (kBorderPlaces - 1);
    const double x_px = first_px + share * (right_px - first_px);
    const double y_px = first_px + share * (bottom_px - first_px);
    if (const auto at = direction_at(first_px, y_px)) seen->left = std::max(seen->left, at->x());
    if (const auto at = direction_at(right_px, y_px)) seen->right = std::min(seen->right, at->x());
    if (const auto at = direction_at(x_px, first_px)) seen->top = std::max(seen->top, at->y());
    if (const auto at = direction_at(x_px, bottom_px))
      seen->bottom = std::min(seen->bottom, at->y());
  }
}

}  // namespace

std::optional<Intrinsics> CommonPinhole(std::span<const Intrinsics> lenses) {
  LF_CHECK(!lenses.empty());
  Directions seen;
  for (const Intrinsics& k : lenses) Restrict(k, &seen);
  const Intrinsics& first = lenses.front();
  Intrinsics pinhole;
  pinhole.fx_px = first.fx_px;
  pinhole.fy_px = first.fy_px;
  // Positions are exact multiples of pixels only by chance; the outermost directions may be missed.
  constexpr double kRounding_px = 1e-6;
  pinhole.width_px =
      static_cast<int>(std::floor((seen.right - seen.left) * pinhole.fx_px + kRounding_px));
  pinhole.height_px =
      static_cast<int>(std::floor((seen.bottom - seen.top) * pinhole.fy_px + kRounding_px));
  if (pinhole.width_px < 1 || pinhole.height_px < 1) return std::nullopt;
  const double share = static_cast<double>(pinhole.width_px) * pinhole.height_px /
                       (static_cast<double>(first.width_px) * first.height_px);
  if (share < kLeastShare) return std::nullopt;
  // The rectangle is in the middle of what is seen.
  pinhole.cx_px = 0.5 * pinhole.width_px - 0.5 * (seen.left + seen.right) * pinhole.fx_px;
  pinhole.cy_px = 0.5 * pinhole.height_px - 0.5 * (seen.top + seen.bottom) * pinhole.fy_px;
  return pinhole;
}

void Undistort(const LfPixels& pixels, const Intrinsics& k, const Intrinsics& pinhole,
               LfPixels* out) {
  LF_CHECK(pixels.bayer == BayerPattern::kNone);
  const DistortionMap map(k.distortion);
  const Mat3 inverse = pinhole.InverseMatrix();
  out->Reset({0, 0, pinhole.width_px, pinhole.height_px}, BayerPattern::kNone);
  for (int y = 0; y < pinhole.height_px; ++y) {
    uint16_t* to = out->radiance.row(y);
    for (int x = 0; x < pinhole.width_px; ++x, to += LfPixels::kRgbLanes) {
      const std::optional<Vec2> distorted = map.Distort(inverse * Vec3(x + 0.5, y + 0.5, 1));
      std::optional<RgbRay> ray;
      if (distorted) {
        const Vec3 at = k.Matrix() * distorted->homogeneous();
        ray = InterpolatePixels(pixels, k.width_px, k.height_px, at.x(), at.y());
      }
      out->any_masked |= !ray;
      const RgbRay value = ray.value_or(RgbRay());
      std::copy(value.begin(), value.end(), to);
      to[LfPixels::kRayLane] = ray ? 1 : 0;
    }
  }
}

}  // namespace lf
