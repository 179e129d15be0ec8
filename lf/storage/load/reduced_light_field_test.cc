// SPDX-License-Identifier: Apache-2.0
// Tests that reduced light fields are loaded from folders and stores.
#include <gtest/gtest.h>

#include <string>

#include "lf/core/file.h"
#include "lf/light_field/model/reduction.h"
#include "lf/pixels/files/image_file.h"
#include "lf/storage/load/folder_store.h"
#include "lf/storage/load/reduced_store.h"
#include "lf/storage/load/test_packed_store.h"

namespace lf {
namespace {

class ReducedLightFieldTest : public PackedStoreTest {
 protected:
  // Loads an LF image of a light field that is reduced by `divisor`.
  LfPixels LoadedReduced(LightField field, uint32_t i, int divisor) {
    EXPECT_TRUE(ReduceLightField(divisor, &field));
    return Loaded(*OpenStore(field, Mosaics::kAsRecorded).value(), {i}, {1, 1, 2, 2});
  }
};

TEST_F(ReducedLightFieldTest, MeansLeaveMaskedPixelsOut) {
  LfPixels pixels({0, 0, 5, 4}, BayerPattern::kNone);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 5; ++x)
      for (int c = 0; c < 3; ++c)
        pixels.radiance.at(x, y, c) = static_cast<uint16_t>(100 * x + 10 * y + c);
  pixels.Mask(0, 0);
  for (const int y : {2, 3}) pixels.Mask(0, y);
  pixels.Mask(1, 2);
  const LfPixels means = MeansOfSquares(pixels, 2);
  EXPECT_EQ(means.rect, (PixelRect{0, 0, 2, 2}));
  EXPECT_EQ(means.radiance.at(0, 0, 1), (100 + 10 + 110 + 3 + 1) / 3);
  EXPECT_EQ(means.radiance.at(1, 0, 2), 250 + 5 + 2);
  EXPECT_TRUE(means.IsMasked(0, 1));
  EXPECT_FALSE(means.IsMasked(1, 1));
  EXPECT_TRUE(means.any_masked);
  EXPECT_EQ(MeansOfSquares(pixels, 8).rect, (PixelRect{0, 0, 1, 1}));
}

TEST_F(ReducedLightFieldTest, FoldersAreReducedToMeans) {
  AddImages<uint8_t>(3);
  MaskRow7OfImage2();
  const FolderStore whole(field_);
  for (const int divisor : {2, 4, 8})
    for (uint32_t i = 0; i < kCount; ++i) {
      const LfPixels expected = MeansOfSquares(Loaded(whole, {i}, kPackedWhole), divisor);
      ExpectSame(LoadedReduced(field_, i, divisor), expected);
    }
}

TEST_F(ReducedLightFieldTest, AReducedLightFieldIsReducedFurther) {
  AddImages<uint8_t>(3);
  LightField reduced = field_;
  ASSERT_TRUE(ReduceLightField(2, &reduced));
  const auto store = OpenStore(reduced, Mosaics::kToRgb).value();
  LfPixels pixels;
  const Result<int> reduction = store->LoadReduced({1}, 4, reduced.intrinsics[0], &pixels);
  ASSERT_TRUE(reduction);
  EXPECT_EQ(*reduction, 1);
  EXPECT_EQ(pixels.rect, (PixelRect{0, 0, kPackedWidth / 2, kPackedHeight / 2}));
  EXPECT_TRUE(store->IsThere({1}));
  EXPECT_TRUE(store->Keeps({1}, {1, 1, 2, 2}));
}

// The pixels of a store whose finest files are missing are what a complete store loads reduced.
TEST_F(ReducedLightFieldTest, StoresByResolutionNeedNoFinerParts) {
  AddImages<uint8_t>(3);
  MaskRow7OfImage2();
  Pack(kPackedWhole, 0, false, 4);
  std::vector<std::vector<LfPixels>> complete(4);
  for (int halvings = 1; halvings <= 3; ++halvings)
    for (uint32_t i = 0; i < kCount; ++i)
      complete[halvings].push_back(LoadedReduced(packed_, i, 1 << halvings));
  for (int halvings = 1; halvings <= 3; ++halvings) {
    std::filesystem::remove(folder_ / ("store-r" + std::to_string(4 - halvings) + ".lfs"));
    const auto whole = Opened();
    for (uint32_t i = 0; i < kCount; ++i) {
      EXPECT_EQ(whole->IsThere({i}), i == 2);
      if (i != 2) {
        EXPECT_NE(ErrorOf(*whole, {i}).find("copy all files of the store again"),
                  std::string::npos);
      }
      ExpectSame(LoadedReduced(packed_, i, 1 << halvings), complete[halvings][i]);
    }
  }
}

TEST_F(ReducedLightFieldTest, MosaicsBecomeRgb) {
  AddImages<uint16_t>(1);
  field_.encoding.bayer = BayerPattern::kGbrg;
  Pack(kPackedWhole, 0, false, 4);
  // The first halving of a mosaic needs all files, and the next one all but the last.
  const LfPixels half = LoadedReduced(packed_, 1, 2);
  const FolderStore files(field_, Mosaics::kToRgb);
  LfPixels expected = MeansOfSquares(Loaded(files, {1}, kPackedWhole), 2);
  EXPECT_EQ(half.radiance.pixels(), expected.radiance.pixels());
  const LfPixels quarter = LoadedReduced(packed_, 1, 4);
  EXPECT_EQ(quarter.bayer, BayerPattern::kNone);
  std::filesystem::remove(folder_ / "store-r3.lfs");
  ExpectSame(LoadedReduced(packed_, 1, 4), quarter);
  LightField field = packed_;
  ASSERT_TRUE(ReduceLightField(2, &field));
  EXPECT_FALSE(OpenStore(field, Mosaics::kToRgb).value()->IsThere({1}));
}

}  // namespace
}  // namespace lf
