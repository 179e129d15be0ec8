// SPDX-License-Identifier: Apache-2.0
#include "lf/render/settings/ray_reading.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "lf/selection/overlap.h"

namespace lf {
namespace {

constexpr PixelFilter kFilters[] = {PixelFilter::kAuto,        PixelFilter::kNearest,
                                    PixelFilter::kBilinear,    PixelFilter::kBicubic,
                                    PixelFilter::kPrefiltered, PixelFilter::kMosaic};

TEST(RayReading, FiltersReachTheirPixels) {
  RayReading reading = Estimator::kBilinear;
  reading.filter = PixelFilter::kBicubic;
  EXPECT_EQ(ReachOf(reading), PixelReach::kNeighbours);
  reading.filter = PixelFilter::kPrefiltered;
  EXPECT_EQ(ReachOf(reading), PixelReach::kElement);
  reading.filter = PixelFilter::kMosaic;
  EXPECT_EQ(ReachOf(reading), PixelReach::kCorrectedElement);
  reading.estimator = Estimator::kNearest;
  EXPECT_EQ(ReachOf(reading), PixelReach::kOwn);
}

TEST(RayReading, TheWidestReachIsThatOfSomeFilter) {
  for (const Estimator estimator : {Estimator::kNearest, Estimator::kBilinear})
    for (const BayerPattern bayer : {BayerPattern::kNone, BayerPattern::kGrbg}) {
      RadianceEncoding encoding;
      encoding.bayer = bayer;
      PixelReach widest = PixelReach::kOwn;
      for (const PixelFilter filter : kFilters) {
        // RGB pixels need no correction.
        if (filter == PixelFilter::kMosaic && bayer == BayerPattern::kNone) continue;
        RayReading reading = estimator;
        reading.filter = filter;
        widest = std::max(widest, ReachOf(reading));
      }
      EXPECT_EQ(WidestReachOf(estimator, encoding), widest);
    }
}

}  // namespace
}  // namespace lf
