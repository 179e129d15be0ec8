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
}

TEST(Resolved, CellsAloneHaveNoLensWeights) {
  const Package package;
  FilmSettings settings;
  EXPECT_EQ(Resolved(settings, package).rebin.interpolation, RayInterpolation::kAuto);
  settings.mode = RenderMode::kRebin;
  FilmSettings resolved = Resolved(settings, package);
  EXPECT_EQ(resolved.rebin.interpolation, RayInterpolation::kPixels);
  EXPECT_EQ(resolved.lens_weights, LensWeights::kAuto);
  settings.lens_weights = LensWeights::kHat;
  EXPECT_EQ(Resolved(settings, package).lens_weights, LensWeights::kHat);
  settings.rebin.query.sigma_st = 0.7;
  resolved = Resolved(settings, package);
  EXPECT_EQ(resolved.rebin.interpolation, RayInterpolation::kCells);
  EXPECT_EQ(resolved.lens_weights, LensWeights::kNone);
  settings.mode = RenderMode::kHybrid;
  EXPECT_EQ(Resolved(settings, package).lens_weights, LensWeights::kHat);
  settings = {};
  settings.mode = RenderMode::kRebin;
  settings.lens_weights = LensWeights::kNone;  // the way of the thesis
  EXPECT_EQ(Resolved(settings, package).rebin.interpolation, RayInterpolation::kCells);
  settings.rebin.interpolation = RayInterpolation::kPixels;
  EXPECT_EQ(Resolved(settings, package).rebin.interpolation, RayInterpolation::kPixels);
}

// The checks of a film resolve settings that may be resolved already.
TEST(Resolved, ResolvingAgainChangesNothing) {
  const Package package;
  for (const RenderMode mode : {RenderMode::kRebin, RenderMode::kHybrid})
    for (const bool is_of_cells : {false, true})
      for (const LensWeights weights : {LensWeights::kAuto, LensWeights::kNone}) {
        FilmSettings settings;
        settings.mode = mode;
        settings.lens_weights = weights;
        settings.stop_when.samples = mode == RenderMode::kHybrid ? 3 : 0;
        if (is_of_cells) settings.rebin.reparameterise = false;
        const FilmSettings once = Resolved(settings, package), twice = Resolved(once, package);
        EXPECT_EQ(once.rebin.interpolation, twice.rebin.interpolation);
        EXPECT_EQ(once.lens_weights, twice.lens_weights);
      }
}

TEST(Resolved, NeedsHaveTheInterpolationAndTheGuard) {
  Package package;
  package.whole_virtual_count = 3;
  FilmSettings settings;
  for (const RenderMode mode : {RenderMode::kRebin, RenderMode::kHybrid}) {
    settings.mode = mode;
    for (const RayInterpolation way : {RayInterpolation::kPixels, RayInterpolation::kCells}) {
      settings.rebin.interpolation = way;
      const NeedsOptions needs = NeedsOfFilm(package, Resolved(settings, package), {});
      EXPECT_EQ(needs.KeepsCells(), way == RayInterpolation::kCells);
      EXPECT_EQ(needs.guard, way == RayInterpolation::kPixels);
    }
  }
}

}  // namespace
}  // namespace lf
