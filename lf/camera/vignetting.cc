// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/vignetting.h"

#include <algorithm>
#include <cmath>

#include "lf/camera/pinhole.h"

namespace lf {

double RadiusSquared(const Intrinsics& k, double x_px, double y_px) {
  const double dx = x_px - k.cx_px, dy = y_px - k.cy_px;
  const double width = k.width_px, height = k.height_px;
  return 4 * (dx * dx + dy * dy) / (width * width + height * height);
}

FalloffRange FalloffRangeOf(const Intrinsics& k) {
  const Vignetting& falloff = k.vignetting;
  const double x = std::clamp<double>(k.cx_px, 0, k.width_px);
  const double y = std::clamp<double>(k.cy_px, 0, k.height_px);
  const double least = RadiusSquared(k, x, y);
  double most = 0;
  for (const int corner_x : {0, k.width_px})
    for (const int corner_y : {0, k.height_px})
      most = std::max(most, RadiusSquared(k, corner_x, corner_y));
  FalloffRange range{falloff.Falloff(least), falloff.Falloff(least)};
  const auto take = [&](double r_squared) {
    const double share = falloff.Falloff(r_squared);
    range.min = std::min(range.min, share);
    range.max = std::max(range.max, share);
  };
  take(most);
  // Between the least and the largest r^2, F has its extremes where v1 + 2 v2 q + 3 v3 q^2 = 0,
  // with q = r^2.
  const auto [v1, v2, v3] = falloff.v;
  const double root = std::sqrt(v2 * v2 - 3 * v1 * v3);
  for (const double extreme : {(-v2 + root) / (3 * v3), (-v2 - root) / (3 * v3), -v1 / (2 * v2)})
    if (extreme > least && extreme < most) take(extreme);
  return range;
}

bool IsFalloff(const Intrinsics& k) {
  const FalloffRange range = FalloffRangeOf(k);
  return range.min >= kLeastFalloff && range.max <= 1 / kLeastFalloff;
}

}  // namespace lf
