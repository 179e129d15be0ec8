// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/load/opacities.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "lf/pixels/files/test_folder.h"
#include "lf/storage/load/folder_store.h"

namespace lf {
namespace {

constexpr int kSide = 16;
constexpr PixelRect kSquare = {0, 0, kSide, kSide};

class OpacitiesTest : public FolderTest {
 protected:
  void SetUp() override {
    FolderTest::SetUp();
    field_.cameras.resize(1);
    field_.intrinsics = {{10, 10, 8, 8, 0, kSide, kSide}};
    field_.image_names = {"a.png"};
    field_.folder = folder_;
    field_.encoding.transfer = Transfer::kLinear;
    field_.encoding.alpha = AlphaMeaning::kStraight;
  }
  // Writes an image in which each of 256 alphas occurs once, with random colours.
  template <class T>
  Image<T> WriteEveryAlpha(int channels) {
    Image<T> image = NoiseImage<T>(kSide, kSide, channels);
    for (int i = 0; i < 256; ++i)
      image.at(i % 16, i / 16, channels - 1) =
          static_cast<T>(i * (std::numeric_limits<T>::max() / 255));
    EXPECT_TRUE(WriteImage(folder_ / "a.png", image.view()));
    return image;
  }
  LfPixels Loaded(const PixelRect& rect = kSquare) const {
    LfPixels pixels;
    const Result<void> loaded = FolderStore(field_).Load({0}, rect, &pixels);
    EXPECT_TRUE(loaded) << loaded.error().message;
    return pixels;
  }

  LightField field_;
};

// Compares the pixels with the formulas of opacities.h in real numbers.
template <class T>
void ExpectComposed(const LightField& field, const Image<T>& stored, const LfPixels& pixels) {
  const RadianceEncoding& encoding = field.encoding;
  const double most = std::numeric_limits<T>::max();
  const int colours = stored.channels() - 1;
  const std::vector<uint16_t> table =
      RadianceTable(encoding, sizeof(T) == 1 ? 8 : 16, field.cameras[0].gain[0]);
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const double a = stored.at(x, y, colours) / most;
      for (int c = 0; c < 3; ++c) {
        const double v = table[stored.at(x, y, colours == 3 ? c : 0)];
        const double behind =
            QuantizeRadiance(encoding, encoding.background ? (*encoding.background)[c] : 0, 1);
        const double expected = encoding.alpha == AlphaMeaning::kStraight
                                    ? a * v + (1 - a) * behind
                                    : v + (1 - a) * (behind - encoding.pedestal);
        // Rounding causes an error of up to 0.5. Alpha in 65534 instead of 65535 steps causes an
        // error of up to 1.
        ASSERT_NEAR(pixels.radiance.at(x, y, c), std::min(expected, 65535.0), 1.51)
            << x << " " << y;
      }
      ASSERT_EQ(pixels.radiance.at(x, y, LfPixels::kRayLane), 1);
    }
}

TEST_F(OpacitiesTest, StraightLightIsComposedOverBlack) {
  const Image<uint8_t> stored = WriteEveryAlpha<uint8_t>(4);
  ExpectComposed(field_, stored, Loaded());
  EXPECT_FALSE(Loaded().any_masked);
}

TEST_F(OpacitiesTest, TheBackgroundIsSeenThroughAndHasNoGain) {
  field_.encoding.background = {0.25, 1, 0.5};
  field_.cameras[0].gain = 0.5;
  const Image<uint16_t> stored = WriteEveryAlpha<uint16_t>(4);
  const LfPixels pixels = Loaded();
  ExpectComposed(field_, stored, pixels);
  EXPECT_EQ(pixels.radiance.at(0, 0, 1), 65535);
  EXPECT_EQ(pixels.radiance.at(0, 0, 0), 16384);
}

TEST_F(OpacitiesTest, PremultipliedLightIsAddedToTheBackgroundAndClips) {
  field_.encoding.alpha = AlphaMeaning::kPremultiplied;
  field_.encoding.background = {0.25, 0.5, 1};
  field_.encoding.pedestal = 1024;
  const Image<uint8_t> stored = WriteEveryAlpha<uint8_t>(4);
  ExpectComposed(field_, stored, Loaded());
}

TEST_F(OpacitiesTest, GreyHasAlphaToo) {
  const Image<uint8_t> stored = WriteEveryAlpha<uint8_t>(2);
  ExpectComposed(field_, stored, Loaded());
}

TEST_F(OpacitiesTest, OpaqueImagesHaveTheBitsOfImagesWithoutAlpha) {
  Image<uint16_t> with = NoiseImage<uint16_t>(kSide, kSide, 4), without(kSide, kSide, 3);
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      with.at(x, y, 3) = 65535;
      for (int c = 0; c < 3; ++c) without.at(x, y, c) = with.at(x, y, c);
    }
  ASSERT_TRUE(WriteImage(folder_ / "a.png", with.view()));
  const LfPixels composed = Loaded();
  ASSERT_TRUE(WriteImage(folder_ / "a.png", without.view()));
  EXPECT_EQ(composed.radiance.pixels(), Loaded().radiance.pixels());
}

TEST_F(OpacitiesTest, MaskFilesMaskWhatIsComposed) {
  WriteEveryAlpha<uint8_t>(4);
  Image<uint8_t> mask(kSide, kSide, 1, 255);
  mask.at(3, 4) = 0;
  ASSERT_TRUE(WriteImage(folder_ / "mask.png", mask.view()));
  field_.mask_names = {"mask.png"};
  const LfPixels pixels = Loaded({2, 2, 9, 9});
  EXPECT_TRUE(pixels.IsMasked(1, 2));
  EXPECT_FALSE(pixels.IsMasked(0, 0));  // although its alpha is below one half
}

TEST_F(OpacitiesTest, WhereNothingIsBehindOpacityIsKeptAndLightIsAsOverBlack) {
  const Image<uint8_t> stored = WriteEveryAlpha<uint8_t>(4);
  const LfPixels over_black = Loaded();
  EXPECT_TRUE(over_black.opacity.empty());
  field_.encoding.background = {0, 0, 0};
  field_.encoding.keeps_opacity = true;
  Image<uint8_t> mask(kSide, kSide, 1, 255);
  mask.at(3, 4) = 0;
  ASSERT_TRUE(WriteImage(folder_ / "mask.png", mask.view()));
  LfPixels pixels = Loaded();
  EXPECT_EQ(pixels.radiance.pixels(), over_black.radiance.pixels());
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x)
      for (int lane = 0; lane < 3; ++lane)
        ASSERT_NEAR(pixels.opacity.at(x, y, lane),
                    LfPixels::kTransparent + std::min(stored.at(x, y, 3) * 257, 65534) /
                                                 65534.0 *  // alpha in 65534 steps
                                                 (LfPixels::kOpaque - LfPixels::kTransparent),
                    0.5001);
  EXPECT_EQ(pixels.opacity.at(0, 0), LfPixels::kTransparent);
  EXPECT_EQ(pixels.opacity.at(15, 15), LfPixels::kOpaque);
  field_.mask_names = {"mask.png"};
  LfPixels part = Loaded({2, 2, 9, 9});
  EXPECT_EQ(part.opacity.at(1, 2, LfPixels::kRayLane), 0);
  EXPECT_EQ(part.opacity.at(1, 1, LfPixels::kRayLane), 1);
  const LfPixels taken = part.TakeOpacity();
  EXPECT_TRUE(part.opacity.empty());
  EXPECT_TRUE(taken.IsMasked(1, 2) && taken.any_masked);
  EXPECT_EQ(taken.radiance.at(0, 0), pixels.opacity.at(2, 2));
}

TEST_F(OpacitiesTest, ImagesWithoutAlphaAreOpaqueButForTheirMasks) {
  field_.encoding.background = {0, 0, 0};
  field_.encoding.keeps_opacity = true;
  ASSERT_TRUE(WriteImage(folder_ / "a.png", NoiseImage<uint8_t>(kSide, kSide, 3).view()));
  Image<uint8_t> mask(kSide, kSide, 1, 255);
  mask.at(3, 4) = 0;
  ASSERT_TRUE(WriteImage(folder_ / "mask.png", mask.view()));
  field_.mask_names = {"mask.png"};
  const LfPixels pixels = Loaded();
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x)
      ASSERT_EQ(pixels.opacity.at(x, y), x == 3 && y == 4 ? 0 : LfPixels::kOpaque);
}

TEST_F(OpacitiesTest, FloatsOutsideOfTheirRangeAreClippedAndNanIsTransparent) {
  field_.image_names = {"a.exr"};
  field_.encoding.background = {1, 1, 1};
  field_.encoding.max_radiance = 2;
  Image<float> image(kSide, kSide, 4);
  image.at(0, 0, 3) = 7;
  image.at(1, 0, 3) = -7;
  image.at(2, 0, 3) = std::numeric_limits<float>::quiet_NaN();
  ASSERT_TRUE(WriteImage(folder_ / "a.exr", image.view(), {"R", "G", "B", "A"}, PixelType::kFloat));
  const LfPixels pixels = Loaded();
  EXPECT_EQ(pixels.radiance.at(0, 0, 1), 0);
  EXPECT_EQ(pixels.radiance.at(1, 0, 1), 32768);
  EXPECT_EQ(pixels.radiance.at(2, 0, 1), 32768);
}

TEST_F(OpacitiesTest, ComposedLightIsClippedBelowTheRoomForOvershoot) {
  field_.image_names = {"a.exr"};
  field_.encoding.alpha = AlphaMeaning::kPremultiplied;
  field_.encoding.background = {1, 1, 1};
  field_.encoding.max_radiance = 2;
  field_.encoding.overshoot_room = 2;
  Image<float> image(kSide, kSide, 4);
  for (int c = 0; c < 3; ++c) image.at(0, 0, c) = 1.8F;
  image.at(0, 0, 3) = 0.1F;
  ASSERT_TRUE(WriteImage(folder_ / "a.exr", image.view(), {"R", "G", "B", "A"}, PixelType::kFloat));
  const LfPixels pixels = Loaded();
  EXPECT_EQ(pixels.radiance.at(0, 0, 1), 32768);  // 2, not 1.8 + 0.9
  EXPECT_EQ(pixels.radiance.at(1, 0, 1), 16384);
}

}  // namespace
}  // namespace lf
