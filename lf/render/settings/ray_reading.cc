// SPDX-License-Identifier: Apache-2.0
#include "lf/render/settings/ray_reading.h"

#include "lf/selection/overlap.h"

namespace lf {

const char* NameOf(Estimator estimator) {
  return estimator == Estimator::kBilinear ? "bilinear" : "nearest";
}

PixelReach ReachOf(const RayReading& reading) {
  if (reading.estimator == Estimator::kNearest) return PixelReach::kOwn;
  return reading.Prefilters() ? PixelReach::kElement : PixelReach::kNeighbours;
}

}  // namespace lf
