// SPDX-License-Identifier: Apache-2.0
#include "lf/render/settings/ray_reading.h"

#include "lf/selection/overlap.h"

namespace lf {

const char* NameOf(Estimator estimator) {
  return estimator == Estimator::kBilinear ? "bilinear" : "nearest";
}

PixelReach ReachOf(const RayReading& reading) {
  if (reading.estimator == Estimator::kNearest) return PixelReach::kOwn;
  if (reading.filter == PixelFilter::kMosaic) return PixelReach::kCorrectedElement;
  return reading.Prefilters() ? PixelReach::kElement : PixelReach::kNeighbours;
}

PixelReach WidestReachOf(Estimator estimator, const RadianceEncoding& encoding) {
  RayReading reading = estimator;
  reading.filter =
      encoding.bayer != BayerPattern::kNone ? PixelFilter::kMosaic : PixelFilter::kPrefiltered;
  return ReachOf(reading);
}

}  // namespace lf
