// SPDX-License-Identifier: Apache-2.0
#include "lf/collection/prefilter/prefilter.h"

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "lf/core/random.h"

namespace lf {
namespace {

std::vector<Prefilter> AllFilters() {
  std::vector<Prefilter> filters;
  for (const auto footprint : {PixelFootprint::kArea, PixelFootprint::kPoint})
    for (double width = 1.3125; width <= kWidestElement_px; width += 0.0625)
      filters.push_back(PrefilterFor(width, footprint));
  return filters;
}

TEST(PrefilterFor, WeightsAddUpToOne) {
  for (const Prefilter& filter : AllFilters()) {
    int sum = filter.is_even ? 0 : -filter.weights[0], reach = 0;
    for (const int weight : filter.weights) {
      sum += 2 * weight;
      reach += std::abs(weight);
    }
    EXPECT_EQ(sum, Prefilter::kOne);
    // Sums of products must fit into 32 bits (prefilter_rows.h).
    EXPECT_LE(2 * reach, 2.8 * Prefilter::kOne);
  }
}

TEST(PrefilterFor, SharpensWhereElementsAreAsLargeAsPixels) {
  const Prefilter area = PrefilterFor(1, PixelFootprint::kArea);
  EXPECT_FALSE(area.is_even);
  EXPECT_LT(area.weights[1], -100);
  const Prefilter point = PrefilterFor(1, PixelFootprint::kPoint);
  EXPECT_LT(point.weights[1], -20);
  EXPECT_GT(point.weights[1], area.weights[1] / 2);
  EXPECT_EQ(PrefilterFor(0.3, PixelFootprint::kArea), area);
  EXPECT_EQ(PrefilterFor(kFinerAtMost, PixelFootprint::kArea), area);
  EXPECT_EQ(PrefilterFor(100, PixelFootprint::kArea),
            PrefilterFor(kWidestElement_px, PixelFootprint::kArea));
  EXPECT_EQ(PrefilterFor(2, PixelFootprint::kArea), PrefilterFor(2.02, PixelFootprint::kArea));
}

// The mean of the pixels of an element is the best value of the element, except for the borders of
// the element and for the blur of interpolation.
TEST(PrefilterFor, AveragesWhereElementsAreCoarse) {
  for (const auto footprint : {PixelFootprint::kArea, PixelFootprint::kPoint})
    for (const int width : {2, 3, 4, 7, 16}) {
      const Prefilter filter = PrefilterFor(width, footprint);
      EXPECT_EQ(filter.is_even, width % 2 == 0);
      const int inside = (width + 1) / 2;
      for (int k = 0; k + 1 < inside; ++k)
        EXPECT_NEAR(filter.weights[static_cast<size_t>(k)], Prefilter::kOne / width,
                    0.12 * Prefilter::kOne / width);
      for (int k = inside; k < filter.count; ++k)
        EXPECT_NEAR(filter.weights[static_cast<size_t>(k)], 0, 0.2 * Prefilter::kOne / width);
    }
}

LfPixels NoisePixels(const PixelRect& rect, uint64_t seed, double masked_share) {
  LfPixels pixels(rect, BayerPattern::kNone);
  for (int y = 0; y < rect.height(); ++y)
    for (int x = 0; x < rect.width(); ++x) {
      for (int c = 0; c < 3; ++c)
        pixels.radiance.at(x, y, c) = static_cast<uint16_t>(
            RandomBits(seed, static_cast<uint64_t>(x + 1000 * y), static_cast<uint64_t>(c)) % 3 == 0
                ? 65535
                : RandomBits(seed, static_cast<uint64_t>(x + 1000 * y),
                             7 + static_cast<uint64_t>(c)));
      if (static_cast<double>(RandomBits(seed, static_cast<uint64_t>(x + 1000 * y), 11) % 1000) <
          1000 * masked_share)
        pixels.Mask(x, y);
    }
  return pixels;
}

void ExpectBitsOfReference(const std::string& target) {
  uint64_t seed = 0;
  for (const double width : {1., 1.5, 2., 2.9, 3.5, 5., 6., 7., 8., 16.})
    for (const double masked : {0., 0.1, 0.7})
      for (const PixelRect rect : {PixelRect{3, 4, 40, 25}, PixelRect{0, 0, 1, 1},
                                   PixelRect{0, 0, 2, 30}, PixelRect{5, 5, 70, 7}}) {
        LfPixels pixels = NoisePixels(rect, ++seed, masked);
        const auto footprint = seed % 2 == 0 ? PixelFootprint::kArea : PixelFootprint::kPoint;
        const Prefilter filter = PrefilterFor(width, footprint);
        LfPixels fast, literal;
        FilterPixels(filter, pixels, &fast);
        FilterPixelsReference(filter, pixels, &literal);
        EXPECT_EQ(fast.radiance.pixels(), literal.radiance.pixels())
            << target << " " << width << " " << masked;
        EXPECT_EQ(fast.any_masked, pixels.any_masked);
        EXPECT_EQ(fast.rect, literal.rect);
        // The rows of the second copy become complete in groups of one to six.
        LfPixels in_place = pixels, in_parts = pixels;
        FilterInPlace(filter, &in_place);
        std::fill(in_parts.radiance.pixels().begin(), in_parts.radiance.pixels().end(), 7);
        InPlaceFilter in_parts_filter(filter, &in_parts);
        for (int y = 0; y < pixels.radiance.height();) {
          const int end = std::min(pixels.radiance.height(), y + 1 + (y + int(seed)) % 6);
          std::copy(pixels.radiance.row(0) + y * pixels.radiance.width() * LfPixels::kRgbLanes,
                    pixels.radiance.row(0) + end * pixels.radiance.width() * LfPixels::kRgbLanes,
                    in_parts.radiance.row(y));
          in_parts_filter.Advance(y = end);
        }
        EXPECT_EQ(in_parts.radiance.pixels(), literal.radiance.pixels())
            << target << " " << width << " " << masked;
        EXPECT_EQ(in_parts.rect, literal.rect);
        EXPECT_EQ(in_place.radiance.pixels(), literal.radiance.pixels())
            << target << " " << width << " " << masked;
        EXPECT_EQ(in_place.rect, literal.rect);
      }
}

TEST(FilterPixels, HasTheBitsOfTheReferenceWithAllInstructions) {
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().DeInit();
    ExpectBitsOfReference(hwy::TargetName(target));
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().DeInit();
}

// Filters change neither: constant light keeps its value exactly, and so does a ramp, apart from
// the borders.
TEST(FilterPixels, KeepsConstantsAndRamps) {
  const PixelRect rect{0, 0, 60, 50};
  for (const double width : {1., 2., 4.5, 16.}) {
    const Prefilter filter = PrefilterFor(width, PixelFootprint::kArea);
    const int shift = filter.is_even ? 1 : 0;
    LfPixels constant(rect, BayerPattern::kNone), ramp(rect, BayerPattern::kNone);
    for (int y = 0; y < rect.height(); ++y)
      for (int x = 0; x < rect.width(); ++x)
        for (int c = 0; c < 3; ++c) {
          constant.radiance.at(x, y, c) = 4711;
          ramp.radiance.at(x, y, c) = static_cast<uint16_t>(9000 + 300 * x - 100 * y);
        }
    LfPixels filtered;
    FilterPixels(filter, constant, &filtered);
    EXPECT_EQ(filtered.radiance.width(), rect.width() - shift);
    for (size_t i = 0; i < filtered.radiance.pixels().size(); ++i)
      ASSERT_EQ(filtered.radiance.pixels()[i], i % 4 == LfPixels::kRayLane ? 1 : 4711) << width;
    FilterPixels(filter, ramp, &filtered);
    for (int y = filter.count; y < rect.height() - filter.count; ++y)
      for (int x = filter.count; x < rect.width() - filter.count; ++x)
        ASSERT_EQ(filtered.radiance.at(x, y, 1), ramp.radiance.at(x, y, 1) + shift * 100) << width;
  }
}

// A pixel's value must not depend on how much of the image is loaded.
TEST(FilterPixels, AValueDependsOnlyOnThePixelsWithinReach) {
  const LfPixels whole = NoisePixels({0, 0, 64, 48}, 5, 0.05);
  const Prefilter filter = PrefilterFor(4, PixelFootprint::kArea);
  LfPixels of_whole;
  FilterPixels(filter, whole, &of_whole);
  const PixelRect part_rect{10, 8, 50, 48};
  LfPixels part(part_rect, BayerPattern::kNone), of_part;
  part.any_masked = true;
  for (int y = 0; y < part_rect.height(); ++y)
    for (int x = 0; x < part_rect.width(); ++x)
      for (int c = 0; c < LfPixels::kRgbLanes; ++c)
        part.radiance.at(x, y, c) = whole.radiance.at(x + 10, y + 8, c);
  FilterPixels(filter, part, &of_part);
  for (int y = filter.count; y < of_part.rect.height(); ++y)
    for (int x = filter.count; x < of_part.rect.width() - filter.count; ++x)
      for (int c = 0; c < 3; ++c)
        ASSERT_EQ(of_part.radiance.at(x, y, c), of_whole.radiance.at(x + 10, y + 8, c));
}

}  // namespace
}  // namespace lf
