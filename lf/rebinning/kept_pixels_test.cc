// SPDX-License-Identifier: Apache-2.0
#include "lf/rebinning/kept_pixels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "lf/core/random.h"
#include "lf/light_field/model/radiance.h"
#include "lf/rebinning/keep_pixels.h"
#include "lf/rebinning/probability_map.h"

namespace lf {
namespace {

constexpr int kColumns = 40, kRows = 30;
const PixelRect kAll = {0, 0, kColumns, kRows};

Intrinsics Camera() { return {50, 50, 20, 15, 0, kColumns, kRows}; }

// Returns an LF image of noise; every ninth pixel is masked.
LfPixels Noise(uint32_t id, BayerPattern pattern, bool has_opacity = false,
               bool has_trust = false) {
  LfPixels pixels(kAll, pattern);
  const int colours = pattern == BayerPattern::kNone ? 3 : 1;
  if (has_opacity) pixels.opacity = Image<uint16_t>(kColumns, kRows, LfPixels::kRgbLanes, 1);
  if (has_trust) pixels.trust = Image<uint8_t>(kColumns, kRows, 1);
  for (int y = 0; y < kRows; ++y)
    for (int x = 0; x < kColumns; ++x) {
      const uint64_t place = static_cast<uint64_t>(y) * kColumns + static_cast<uint64_t>(x);
      for (int c = 0; c < colours; ++c)
        pixels.radiance.at(x, y, c) =
            static_cast<uint16_t>(RandomBits(id, static_cast<uint64_t>(c), place));
      if (has_opacity)
        for (int c = 0; c < 3; ++c)
          pixels.opacity.at(x, y, c) = static_cast<uint16_t>(20000 + place);
      if (has_trust) pixels.trust.at(x, y) = static_cast<uint8_t>(place);
      if (place % 9 == 4) pixels.Mask(x, y);
    }
  return pixels;
}

KeptImage Keep(uint32_t id, const LfPixels& pixels, std::vector<PixelRect> asked,
               bool keeps_all = true) {
  RadianceEncoding encoding;
  return KeepPixels(LfImageId{id}, Camera(), pixels, pixels.opacity, asked, keeps_all,
                    StoredValueTable(encoding), {});
}

void ExpectSamePixels(const LfPixels& found, const LfPixels& all, const PixelRect& rect) {
  EXPECT_EQ(found.bayer, all.bayer);
  for (int y = rect.y_begin; y < rect.y_end; ++y)
    for (int x = rect.x_begin; x < rect.x_end; ++x) {
      const int i = x - found.rect.x_begin, k = y - found.rect.y_begin;
      ASSERT_EQ(found.IsMasked(i, k), all.IsMasked(x, y)) << x << " " << y;
      if (all.IsMasked(x, y)) continue;
      for (int c = 0; c < all.radiance.channels(); ++c)
        ASSERT_EQ(found.radiance.at(i, k, c), all.radiance.at(x, y, c)) << x << " " << y;
      for (int c = 0; c < 3 && !all.opacity.empty(); ++c)
        ASSERT_EQ(found.opacity.at(i, k, c), all.opacity.at(x, y, c));
      if (!all.trust.empty()) {
        ASSERT_EQ(found.trust.at(i, k), all.trust.at(x, y));
      }
    }
}

TEST(KeptPixels, AllPixelsThatFramesAskForAreThereAsTheyWere) {
  ThreadPool pool(2);
  for (const BayerPattern pattern : {BayerPattern::kNone, BayerPattern::kRggb})
    for (const bool has_more : {false, true}) {
      if (has_more && pattern != BayerPattern::kNone) continue;
      const LfPixels pixels = Noise(3, pattern, has_more, has_more);
      // Two rectangles that overlap, and one apart from them.
      const std::vector<PixelRect> asked = {{2, 3, 20, 12}, {10, 8, 25, 20}, {30, 25, 40, 30}};
      KeptPixels kept(10000);
      kept.Add({Keep(3, pixels, asked)}, pool);
      LfPixels loaded;
      kept.Load(LfImageId{3}, {0, 0, 100, 100}, &loaded);
      EXPECT_EQ(loaded.rect, kAll);
      size_t unmasked = 0;
      for (const PixelRect& rect : asked) ExpectSamePixels(loaded, pixels, rect);
      for (int y = 0; y < kRows; ++y)
        for (int x = 0; x < kColumns; ++x) {
          const bool is_asked = std::any_of(asked.begin(), asked.end(),
                                            [&](const auto& rect) { return rect.Contains(x, y); });
          EXPECT_TRUE(is_asked || loaded.IsMasked(x, y));
          if (is_asked && !pixels.IsMasked(x, y)) ++unmasked;
        }
      EXPECT_EQ(kept.size(), unmasked);
      EXPECT_EQ(PixelsIn(asked), 162u + 180u - 40u + 50u);
      // A part that begins elsewhere has the same pixels.
      kept.Load(LfImageId{3}, {12, 9, 18, 15}, &loaded);
      EXPECT_EQ(loaded.rect, (PixelRect{12, 9, 18, 15}));
      ExpectSamePixels(loaded, pixels, {12, 9, 18, 12});
    }
}

TEST(KeptPixels, PixelsAtEdgesStayAndTheOthersAreInterpolated) {
  ThreadPool pool(2);
  for (const BayerPattern pattern : {BayerPattern::kNone, BayerPattern::kGbrg}) {
    const LfPixels pixels = Noise(4, pattern);
    KeptPixels kept(10000);
    kept.Add({Keep(4, pixels, {kAll}, false)}, pool);
    const KeptImage& image = kept.images().at(LfImageId{4});
    EXPECT_GT(kept.size(), 40u);
    EXPECT_LT(kept.size(), static_cast<size_t>(kAll.pixel_count()));
    LfPixels loaded;
    kept.Load(LfImageId{4}, kAll, &loaded);
    for (const uint32_t place : image.places) {
      const int x = static_cast<int>(place) % kColumns, y = static_cast<int>(place) / kColumns;
      EXPECT_FALSE(pixels.IsMasked(x, y));
      EXPECT_EQ(loaded.radiance.at(x, y), pixels.radiance.at(x, y));
    }
    for (int y = 0; y < kRows; ++y)
      for (int x = 0; x < kColumns; ++x) EXPECT_EQ(loaded.IsMasked(x, y), pixels.IsMasked(x, y));
  }
}

// In a mosaic, the green pixels must not be interpolated from red and blue ones.
TEST(KeptPixels, PlacesOfAMosaicAreInterpolatedByThemselves) {
  ThreadPool pool(1);
  LfPixels pixels(kAll, BayerPattern::kRggb);
  for (int y = 0; y < kRows; ++y)
    for (int x = 0; x < kColumns; ++x)
      pixels.radiance.at(x, y) =
          static_cast<uint16_t>(1000 + 20000 * BayerChannel(BayerPattern::kRggb, x, y));
  KeptPixels kept(100);  // a twelfth of the pixels
  kept.Add({Keep(1, pixels, {kAll})}, pool);
  EXPECT_LE(kept.size(), 100u);
  EXPECT_GT(kept.size(), 60u);
  EXPECT_LT(kept.limit(), UINT64_MAX);
  LfPixels loaded;
  kept.Load(LfImageId{1}, kAll, &loaded);
  for (int y = 0; y < kRows; ++y)
    for (int x = 0; x < kColumns; ++x)
      EXPECT_EQ(loaded.radiance.at(x, y), pixels.radiance.at(x, y)) << x << " " << y;
}

// The part that is loaded must not decide about the values, also across the tiles of a large image.
TEST(KeptPixels, APartOfASparseImageHasTheValuesOfTheWhole) {
  ThreadPool pool(1);
  const PixelRect large = {0, 0, 600, 300};
  LfPixels pixels(large, BayerPattern::kNone);
  for (int y = 0; y < 300; ++y)
    for (int x = 0; x < 600; ++x)
      for (int c = 0; c < 3; ++c)
        pixels.radiance.at(x, y, c) = static_cast<uint16_t>(100 * x + 20 * y + 1000 * c);
  KeptPixels kept(15000);
  kept.Add({KeepPixels(LfImageId{0}, {50, 50, 300, 150, 0, 600, 300}, pixels, {},
                       std::span(&large, 1), true, StoredValueTable(RadianceEncoding()), {})},
           pool);
  LfPixels whole, part;
  kept.Load(LfImageId{0}, large, &whole);
  const PixelRect rect = {240, 200, 530, 290};
  kept.Load(LfImageId{0}, rect, &part);
  double most = 0;
  for (int y = rect.y_begin; y < rect.y_end; ++y)
    for (int x = rect.x_begin; x < rect.x_end; ++x) {
      ASSERT_EQ(part.radiance.at(x - rect.x_begin, y - rect.y_begin), whole.radiance.at(x, y));
      most = std::max(most, std::abs(whole.radiance.at(x, y) - (100.0 * x + 20 * y)));
    }
  EXPECT_LT(most, 2000);  // of 66000: kept pixels are about four pixels apart
}

// If nothing is kept far and wide, the nearest kept pixels decide; an LF image of which nothing
// is kept is masked, and never black.
TEST(KeptPixels, EvenPartsFarFromEdgesAreFilled) {
  ThreadPool pool(1);
  for (const BayerPattern pattern : {BayerPattern::kNone, BayerPattern::kRggb})
    for (const bool has_edge : {true, false}) {
      const PixelRect large = {3, 1, 700, 301};
      LfPixels pixels(large, pattern);
      for (int y = 0; y < large.height(); ++y)
        for (int x = 0; x < large.width(); ++x)
          for (int c = 0; c < (pattern == BayerPattern::kNone ? 3 : 1); ++c)
            pixels.radiance.at(x, y, c) = has_edge && x < 8 ? 60000 : 20000;
      RebinOptions options;
      options.probability.xi = 0;
      KeptPixels kept(1'000'000);
      kept.Add(
          {KeepPixels(LfImageId{0}, {50, 50, 350, 150, 0, 700, 301}, pixels, {},
                      std::span(&large, 1), false, StoredValueTable(RadianceEncoding()), options)},
          pool);
      EXPECT_EQ(kept.size() > 0, has_edge);
      LfPixels loaded;
      kept.Load(LfImageId{0}, large, &loaded);
      for (int x : {300, 500, 690}) {
        EXPECT_EQ(loaded.IsMasked(x - 3, 200), !has_edge);
        if (has_edge) {
          EXPECT_NEAR(loaded.radiance.at(x - 3, 200), 40000, 20001);
        }
      }
    }
}

TEST(KeptPixels, LightIsInterpolatedByItsSquareRootAndTrustAsItIs) {
  ThreadPool pool(1);
  KeptImage image;
  image.width_px = 3;
  image.height_px = 1;
  image.has_trust = true;
  image.is_sparse = true;
  image.rect = {0, 0, 3, 1};
  image.places = {0, 2};
  image.values = {0, 2500, 10000, 0, 40000, 2500, 10000, 200};
  KeptPixels kept(10);
  kept.Add({image}, pool);
  LfPixels loaded;
  kept.Load(LfImageId{}, image.rect, &loaded);
  EXPECT_NEAR(loaded.radiance.at(1, 0, 0), 100 * 100, 100);
  EXPECT_NEAR(loaded.radiance.at(1, 0, 1), 2500, 1);
  EXPECT_NEAR(loaded.radiance.at(1, 0, 2), 10000, 1);
  EXPECT_NEAR(loaded.trust.at(1, 0), 100, 1);
}

// Masks and depths stay when pixels are dropped. Beyond kFreeBytes, they leave room for fewer.
TEST(KeptPixels, MasksAndDepthsCountAsPixels) {
  constexpr size_t kMost = 3'000'000;
  constexpr int kSide = 1500;
  std::vector<KeptImage> images;
  for (uint32_t id = 0; id < 3; ++id) {
    KeptImage image;
    image.id = LfImageId{id};
    image.width_px = image.height_px = kSide;
    image.bayer = BayerPattern::kRggb;
    image.rect = {0, 0, kSide, kSide};
    for (uint32_t place = 0; place < kSide * kSide; place += 2) image.places.push_back(place);
    image.values.resize(image.places.size());
    image.masked.resize(image.masked_words());
    image.depths.numbers = Image<uint16_t>(kSide, kSide);
    images.push_back(std::move(image));
  }
  ThreadPool pool(2);
  KeptPixels kept(kMost), backwards(kMost), few(1000);
  kept.Add(images, pool);
  for (auto image = images.rbegin(); image != images.rend(); ++image) backwards.Add({*image}, pool);
  EXPECT_GT(kept.other_bytes(), KeptPixels::kFreeBytes);
  EXPECT_LE(kept.size_bytes(), kMost * KeptPixels::kLeastPixelBytes + KeptPixels::kFreeBytes);
  EXPECT_GT(kept.size(), 1'500'000u);
  EXPECT_FALSE(kept.is_too_small());
  EXPECT_EQ(kept.limit(), backwards.limit());
  EXPECT_EQ(kept.size(), backwards.size());
  few.Add(images, pool);
  EXPECT_TRUE(few.is_too_small());
  EXPECT_EQ(few.size(), 0u);
}

TEST(KeptPixels, ThoseThatAreDroppedDependOnNoOrder) {
  std::vector<KeptImage> images;
  for (uint32_t id = 0; id < 12; ++id)
    images.push_back(Keep(id, Noise(id, BayerPattern::kNone), {{0, 0, 30, 20}}));
  ThreadPool one(1), three(3);
  KeptPixels expected(1000), backwards(1000);
  expected.Add(images, three);
  for (auto image = images.rbegin(); image != images.rend(); ++image) backwards.Add({*image}, one);
  EXPECT_LE(expected.size(), 1000u);
  EXPECT_GT(expected.size(), 800u);
  EXPECT_EQ(expected.limit(), backwards.limit());
  EXPECT_EQ(expected.size(), backwards.size());
  for (const auto& [id, image] : expected.images()) {
    EXPECT_EQ(image.places, backwards.images().at(id).places);
    EXPECT_EQ(image.values, backwards.images().at(id).values);
    for (const uint32_t place : image.places)
      EXPECT_LT(KeptPixels::HashOf(id, static_cast<uint64_t>(place / 30) * kColumns + place % 30),
                expected.limit());
  }
}

}  // namespace
}  // namespace lf
