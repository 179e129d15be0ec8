// SPDX-License-Identifier: Apache-2.0
#include "lf/render/pipeline/resolved_settings.h"

#include <gtest/gtest.h>

namespace lf {
namespace {

TEST(Resolved, APackageStatesWhatItWasMadeWith) {
  Package package;
  package.choices.seed = 7;
  package.choices.order = ImageOrder::kArea;
  package.choices.max_angle_rad = 0.5;
  package.choices.max_image_count = 9;
  FilmSettings settings;
  settings.seed = 3;
  settings.order = ImageOrder::kRoundRobin;
  settings.max_angle_rad = 1;
  const FilmSettings resolved = Resolved(settings, package);
  EXPECT_EQ(resolved.seed, 7u);
  EXPECT_EQ(resolved.rebin.rebin.seed, 7u);
  EXPECT_EQ(resolved.rebin.query.seed, 7u);
  EXPECT_EQ(resolved.order, ImageOrder::kArea);
  EXPECT_EQ(resolved.max_angle_rad, 0.5);
  EXPECT_EQ(resolved.max_image_count, 9u);
  settings.max_image_count = 4;
  EXPECT_EQ(Resolved(settings, package).max_image_count, 4u);
}

TEST(Resolved, AutoBecomesWhatTheRenderUses) {
  const Package package;
  FilmSettings settings;
  EXPECT_EQ(Resolved(settings, package).lens_weights, LensWeights::kAuto);
  EXPECT_EQ(Resolved(settings, package).reading.filter, PixelFilter::kPrefiltered);
  settings.smooth_below = 1;  // smooths nothing
  EXPECT_EQ(Resolved(settings, package).lens_weights, LensWeights::kAuto);
  settings.smooth_below = 3;  // counts rays
  EXPECT_EQ(Resolved(settings, package).lens_weights, LensWeights::kNone);
  settings.lens_weights = LensWeights::kHat;
  EXPECT_EQ(Resolved(settings, package).lens_weights, LensWeights::kHat);
  settings.mode = RenderMode::kRebin;
  EXPECT_EQ(Resolved(settings, package).lens_weights, LensWeights::kNone);
}

}  // namespace
}  // namespace lf
