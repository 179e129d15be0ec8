// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/compress/demosaicked_images.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "lf/distribute/compress/compress.h"
#include "lf/distribute/compress/test_drawn_capture.h"
#include "lf/storage/load/open_store.h"

namespace lf {
namespace {

class DemosaickedImagesTest : public DrawnCaptureTest {
 protected:
  static constexpr PixelRect kWhole{0, 0, kWidth, kHeight};

  void SetUp() override {
    DrawnCaptureTest::SetUp();
    MakeCapture<uint16_t>(PixelLayout::kMosaic);
    RadianceEncoding& encoding = source_.light_field.encoding;
    encoding.transfer = Transfer::kLinear;
    encoding.black_level = 1000;
    encoding.white_level = 60000;
    encoding.white_balance = {1, 1.25, 1.6};
  }

  // Makes a store, and returns the LF image `id` as it is loaded from it.
  LfPixels Stored(const CompressSource& source, uint32_t id) {
    CompressOptions options;
    options.store = folder_ / "a.lfs";
    options.codec.profile = CodecProfile::kLossless;
    options.files = KeepFiles::kNone;
    options.overwrite = true;
    const auto report = Compress(source, options, pool_, {});
    EXPECT_TRUE(report) << report.error().message;
    EXPECT_TRUE(report->demosaicked);
    const auto facts = ReadPackedStore(options.store);
    EXPECT_TRUE(facts) << facts.error().message;
    field_ = facts->light_field;
    EXPECT_EQ(field_.encoding.bayer, BayerPattern::kNone);
    EXPECT_EQ(facts->whole, source_.whole);
    const auto store = OpenStore(field_, Mosaics::kToRgb);
    EXPECT_TRUE(store) << store.error().message;
    LfPixels pixels;
    EXPECT_TRUE((*store)->Load(LfImageId{id}, kWhole, &pixels));
    return pixels;
  }

  ThreadPool pool_{2};
  LightField field_;  // of the store
};

TEST_F(DemosaickedImagesTest, AStoreHasTheRadianceOfTheMosaics) {
  LightField& mosaics = source_.light_field;
  mosaics.intrinsics[0].vignetting.v = {-0.3, 0, 0};
  for (LfCamera& camera : mosaics.cameras) camera.gain = {0.8F, 0.5F, 0.9F};
  source_.whole = IdentityOf(mosaics);
  const auto source = DemosaickedJointly(source_.light_field);
  ASSERT_TRUE(source) << source.error().message;
  const LfPixels stored = Stored(*source, 7);

  const auto joint = JointDemosaicker::Make(mosaics, pool_, {});
  ASSERT_TRUE(joint) << joint.error().message;
  const auto expected = (*joint)->Demosaic(LfImageId{7});
  ASSERT_TRUE(expected);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      for (int c = 0; c < 3; ++c) {
        const double radiance =
            (stored.radiance.at(x, y, c) - field_.encoding.pedestal) / field_.encoding.Scale();
        ASSERT_NEAR(radiance, std::min(1.0F, expected->rgb.at(x, y, c)), 1e-4);
      }
}

TEST_F(DemosaickedImagesTest, MaskedPixelsStayMasked) {
  // The mask of LF image 3 hides its left half.
  Image<uint8_t> mask(kWidth, kHeight, 1, 255);
  for (int y = 0; y < kHeight; ++y) std::fill_n(mask.row(y), kWidth / 2, uint8_t{0});
  ASSERT_TRUE(WriteImage(folder_ / "mask.png", mask.view()));
  source_.light_field.mask_names.assign(source_.light_field.size(), "");
  source_.light_field.mask_names[3] = "mask.png";
  source_.whole = IdentityOf(source_.light_field);
  const auto source = DemosaickedJointly(source_.light_field);
  ASSERT_TRUE(source) << source.error().message;
  const LfPixels stored = Stored(*source, 3);
  EXPECT_TRUE(stored.IsMasked(kWidth / 2 - 10, 30));
  EXPECT_FALSE(stored.IsMasked(kWidth / 2 + 10, 30));
}

TEST_F(DemosaickedImagesTest, TheEncodingHoldsTheLightOfAllGains) {
  LightField mosaics = source_.light_field;
  EXPECT_EQ(RgbEncodingOf(mosaics).white_level, 65535);
  mosaics.cameras[2].gain = 0.25F;
  const RadianceEncoding darker = RgbEncodingOf(mosaics);
  EXPECT_EQ(darker.white_level, 4096 + (65535 - 4096) / 4.0);
  EXPECT_EQ(darker.white_balance, mosaics.encoding.white_balance);
  EXPECT_TRUE(LevelsFit(darker, 16));
  mosaics.cameras[2].gain = 8;
  EXPECT_TRUE(LevelsFit(RgbEncodingOf(mosaics), 16));
}

TEST_F(DemosaickedImagesTest, TheFootprintIsThatOfTheColoursUnlessItIsStated) {
  source_.light_field.encoding.footprint = PixelFootprint::kPoint;
  const auto stated = DemosaickedJointly(source_.light_field);
  ASSERT_TRUE(stated);
  Stored(*stated, 0);
  EXPECT_EQ(field_.encoding.footprint, PixelFootprint::kPoint);
  source_.light_field.encoding.footprint.reset();
  const auto measured = DemosaickedJointly(source_.light_field);
  ASSERT_TRUE(measured);
  Stored(*measured, 0);
  // The drawn texture has no sharp edges.
  EXPECT_EQ(field_.encoding.footprint, PixelFootprint::kArea);
}

TEST_F(DemosaickedImagesTest, OnlyMosaicsAreDemosaicked) {
  source_.light_field.encoding.bayer = BayerPattern::kNone;
  const auto source = DemosaickedJointly(source_.light_field);
  ASSERT_FALSE(source);
  EXPECT_EQ(source.error().kind, ErrorKind::kUsage);
}

}  // namespace
}  // namespace lf
