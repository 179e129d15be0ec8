// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/prediction/predict.h"

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <cmath>
#include <random>

#include "lf/pixels/prediction/prediction_cell.h"

namespace lf {
namespace {

template <class Pixel>
Image<Pixel> Noise(std::mt19937& random, int width, int height, int channels) {
  Image<Pixel> image(width, height, channels);
  for (Pixel& value : image.pixels()) value = static_cast<Pixel>(random());
  return image;
}

template <class Pixel>
ReferencePart<Pixel> Whole(const Image<Pixel>& image) {
  return {image.view(), 0, 0, image.width(), image.height()};
}

PlaneWarp Shift(double x, double y) {
  PlaneWarp warp = IdentityWarp();
  warp.far[0][2] = std::llround(x * (1 << kWarpBits));
  warp.far[1][2] = std::llround(y * (1 << kWarpBits));
  return warp;
}

// Returns a shift, a nearby homography, or any numbers within the limits.
PlaneWarp AnyWarp(std::mt19937& random) {
  const auto unit = [&] { return std::uniform_real_distribution<double>(-1, 1)(random); };
  const auto any = [&](double most) {
    return static_cast<int64_t>(unit() * most * std::exp2(-static_cast<double>(random() % 45)));
  };
  PlaneWarp warp = Shift(20 * unit(), 20 * unit());
  if (random() % 3 == 0) return warp;
  if (random() % 2 == 0) {
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 2; ++column)
        warp.far[row][column] +=
            static_cast<int64_t>(unit() * (1 << kWarpBits) * (row == 2 ? 1e-4 : 0.05));
    for (int64_t& step : warp.step) step = static_cast<int64_t>(unit() * (1 << kWarpBits) / 10);
    return warp;
  }
  for (int row = 0; row < 3; ++row) {
    warp.far[row] = {any(kMostSlope), any(kMostSlope), any(kMostOrigin)};
    warp.step[row] = any(kMostStep);
  }
  return warp;
}

PredictionPlan AnyPlan(std::mt19937& random, int width, int height) {
  PredictionPlan plan;
  plan.warps.resize(1 + random() % kMostReferences);
  for (PlaneWarp& warp : plan.warps) warp = AnyWarp(random);
  plan.blocks = MakeBlockField(width, height, kLeastBlockBits + static_cast<int>(random() % 3), 1);
  const unsigned masks = (1U << plan.warps.size()) - 1;
  const bool is_even = random() % 3 == 0;  // few depths and masks, so that neighbours agree
  for (uint8_t& depth : plan.blocks.depths)
    depth = static_cast<uint8_t>(random() % (is_even ? 2 : kDepthSteps));
  for (uint8_t& mask : plan.blocks.masks)
    mask = static_cast<uint8_t>(is_even ? masks : 1 + random() % masks);
  return plan;
}

PixelRect AnyRect(std::mt19937& random, int width, int height) {
  const int x = static_cast<int>(random() % width), y = static_cast<int>(random() % height);
  return {x, y, static_cast<int>(x + 1 + random() % (width - x)),
          static_cast<int>(y + 1 + random() % (height - y))};
}

template <class Pixel>
void CompareWithReference(unsigned seed) {
  std::mt19937 random(seed);
  for (int i = 0; i < 300; ++i) {
    const int channels = std::array{1, 3, 4}[i % 3];
    const int width = static_cast<int>(1 + random() % 90),
              height = static_cast<int>(1 + random() % 70);
    const PredictionPlan plan = AnyPlan(random, width, height);
    std::vector<Image<Pixel>> images;
    for (size_t r = 0; r < plan.warps.size(); ++r)
      images.push_back(Noise<Pixel>(random, static_cast<int>(1 + random() % 90),
                                    static_cast<int>(1 + random() % 70), channels));
    std::vector<ReferencePart<Pixel>> references;
    for (const Image<Pixel>& image : images) references.push_back(Whole(image));
    const PixelRect all = {0, 0, width, height};
    Image<Pixel> expected(width, height, channels), found(width, height, channels);
    PredictReference<Pixel>(plan, references, all, expected.view());
    for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
      hwy::SetSupportedTargetsForTest(target);
      hwy::GetChosenTarget().DeInit();
      found.pixels().assign(found.pixels().size(), 77);
      Predict<Pixel>(plan, references, all, found.view());
      hwy::SetSupportedTargetsForTest(0);
      hwy::GetChosenTarget().DeInit();
      ASSERT_EQ(expected.pixels(), found.pixels())
          << "case " << i << ", " << hwy::TargetName(target);
    }

    // A rectangle is a crop of the whole, and needs only the stated parts of the reference images.
    const PixelRect rect = AnyRect(random, width, height);
    std::vector<ReferenceSize> sizes;
    for (const Image<Pixel>& image : images) sizes.push_back({image.width(), image.height()});
    const std::vector<PixelRect> needed = NeededOfReferences(plan, sizes, rect);
    std::vector<Image<Pixel>> parts(images.size());
    for (size_t r = 0; r < images.size(); ++r) {
      const PixelRect& part = needed[r];
      parts[r] = Image<Pixel>(part.width(), part.height(), channels);
      for (int y = 0; y < part.height(); ++y)
        std::copy_n(&images[r].at(part.x_begin, part.y_begin + y), part.width() * channels,
                    parts[r].row(y));
      references[r] = {std::as_const(parts[r]).view(), part.x_begin, part.y_begin,
                       images[r].width(), images[r].height()};
    }
    Image<Pixel> crop(rect.width(), rect.height(), channels);
    Predict<Pixel>(plan, references, rect, crop.view());
    for (int y = 0; y < rect.height(); ++y)
      for (int x = 0; x < rect.width() * channels; ++x)
        ASSERT_EQ(crop.row(y)[x], expected.row(rect.y_begin + y)[rect.x_begin * channels + x])
            << "case " << i;
  }
}

TEST(Predict, PixelsOf8BitsAreThoseOfTheReferenceImplementation) {
  CompareWithReference<uint8_t>(1);
}
TEST(Predict, PixelsOf16BitsAreThoseOfTheReferenceImplementation) {
  CompareWithReference<uint16_t>(2);
}

// A warp that moves all pixels alike has the motion of one whose numbers hardly differ.
TEST(Predict, ShiftsMoveAsOtherWarpsDo) {
  std::mt19937 random(6);
  for (int i = 0; i < 2000; ++i) {
    const double most = std::exp2(static_cast<double>(random() % 14));
    PlaneWarp shift = Shift(most * std::uniform_real_distribution<double>(-1, 1)(random), 0.3);
    shift.step[1] = 1 << (random() % 30);
    PlaneWarp other = shift;
    other.far[2][0] = 1;  // moves by less than the smallest unit within the cell
    CellMotion motion, expected;
    SetMotion(shift, 9, -8, 8, 4, &motion);
    SetMotion(other, 9, -8, 8, 4, &expected);
    ASSERT_EQ(motion.square, 16);
    ASSERT_NEAR(motion.At(0, 0).x, expected.At(0, 0).x, 1);
    ASSERT_NEAR(motion.At(0, 0).y, expected.At(0, 0).y, 1);
  }
}

TEST(Predict, TapsInterpolate) {
  for (int phase = 0; phase < kPhases; ++phase) {
    const Taps& taps = kTapsOfPhase[phase];
    EXPECT_EQ(taps[0] + taps[1] + taps[2] + taps[3], 1 << kTapBits);
    // The values of a ramp are found to 1/24 of a step.
    EXPECT_NEAR((-taps[0] + taps[2] + 2 * taps[3]) / 128.0, phase / 64.0, 1.0 / 24);
  }
  EXPECT_EQ(kTapsOfPhase[0], (Taps{0, 128, 0, 0}));
  EXPECT_EQ(kTapsOfPhase[32], (Taps{-10, 74, 74, -10}));
}

// A whole number of pixels: all values are copied exactly, whatever the blocks are.
template <class Pixel>
void ShiftIsExact() {
  std::mt19937 random(3);
  const Image<Pixel> image = Noise<Pixel>(random, 100, 80, 3);
  PredictionPlan plan{{Shift(7, -5), Shift(7, -5)}, MakeBlockField(100, 80, 4, 3)};
  for (uint8_t& mask : plan.blocks.masks) mask = static_cast<uint8_t>(1 + random() % 3);
  const std::vector<ReferencePart<Pixel>> references = {Whole(image), Whole(image)};
  Image<Pixel> found(100, 80, 3);
  Predict<Pixel>(plan, references, {0, 0, 100, 80}, found.view());
  for (int y = 0; y < 80; ++y)
    for (int x = 0; x < 100; ++x)
      for (int c = 0; c < 3; ++c)
        ASSERT_EQ(found.at(x, y, c), image.at(std::min(x + 7, 99), std::max(y - 5, 0), c));
}
TEST(Predict, WholeShiftsAreExact) {
  ShiftIsExact<uint8_t>();
  ShiftIsExact<uint16_t>();
}

TEST(Predict, EvenAreasStayEven) {
  for (const int value : {0, 1, 127, 128, 254, 255}) {
    const Image<uint8_t> image(50, 50, 1, static_cast<uint8_t>(value));
    PredictionPlan plan{{Shift(.3, .7), Shift(-2.2, 9.9), Shift(4.4, .1)},
                        MakeBlockField(50, 50, 3, 7)};
    std::mt19937 random(4);
    for (uint8_t& mask : plan.blocks.masks) mask = static_cast<uint8_t>(1 + random() % 7);
    const std::vector<ReferencePart<uint8_t>> references(3, Whole(image));
    Image<uint8_t> found(50, 50);
    Predict<uint8_t>(plan, references, {0, 0, 50, 50}, found.view());
    for (const uint8_t pixel : found.pixels()) ASSERT_EQ(pixel, value);
  }
}

// Around the border of two blocks of different brightness, the brightness changes evenly.
TEST(Predict, BlocksOverlap) {
  const Image<uint8_t> dark(64, 64, 1, 0), bright(64, 64, 1, 240);
  PredictionPlan plan{{IdentityWarp(), IdentityWarp()}, MakeBlockField(64, 64, 4, 1)};
  for (int row = 0; row < 4; ++row)
    plan.blocks.masks[row * 4 + 2] = plan.blocks.masks[row * 4 + 3] = 2;
  const std::vector<ReferencePart<uint8_t>> references = {Whole(dark), Whole(bright)};
  Image<uint8_t> found(64, 64);
  Predict<uint8_t>(plan, references, {0, 0, 64, 64}, found.view());
  for (int x = 0; x < 64; ++x) {
    const double share = std::clamp((x + 0.5 - 28) / 8, 0.0, 1.0);
    EXPECT_NEAR(found.at(x, 33), 240 * share, 1) << x;
  }
}

}  // namespace
}  // namespace lf
