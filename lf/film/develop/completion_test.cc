// SPDX-License-Identifier: Apache-2.0
#include "lf/film/develop/completion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "lf/core/random.h"
#include "lf/film/develop/test_plates.h"
#include "lf/film/plate/sensor_plate.h"

namespace lf {
namespace {

using testing::GuardedOf;
using testing::RandomPlate;
using testing::WithRedOpacity;

constexpr int kWidth = 50, kHeight = 37;

// Returns shares from 0 to 1: a third are 0, and a third are 1.
Image<float> RandomShares(uint64_t seed) {
  Image<float> shares(kWidth, kHeight);
  for (size_t i = 0; i < shares.pixels().size(); ++i)
    shares.pixels()[i] = static_cast<float>(
        std::clamp(3 * RandomUnit(seed, 3, static_cast<uint64_t>(i)) - 1, 0.0, 1.0));
  return shares;
}

// Returns noise with random shares. The opacity, if asked for, is the red channel.
Completion RandomCompletion(bool has_opacity, uint64_t seed) {
  Completion completion{Image<float>(kWidth, kHeight, 3), RandomShares(seed)};
  uint64_t i = 0;
  for (float& value : completion.rgb.pixels())
    value = static_cast<float>(65535 * RandomUnit(seed, 4, i++));
  if (!has_opacity) return completion;
  completion.opacity = Image<float>(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) completion.opacity.at(x, y) = completion.rgb.at(x, y, 0);
  return completion;
}

// Returns the options by which a frame has the values of its plate.
DevelopOptions InValues() {
  DevelopOptions options;
  options.scale = 1;
  options.fill_radius_px = 0;
  return options;
}

TEST(Completion, OpacityIsMixedLikeAColourAndThenMapped) {
  SensorPlate plate(3, 1, PlateKind::kOpacity);
  for (int c = 0; c < 4; ++c) plate.Add(0, 0, c, {2 * 3000, 2});
  Completion completion{Image<float>(3, 1, 3, 5000), Image<float>(3, 1), Image<float>(3, 1, 1, 7)};
  completion.opacity.at(0, 0) = 7000;
  completion.opacity.at(1, 0) = 5000;
  completion.share.at(0, 0) = 0.25F;
  completion.share.at(1, 0) = 0.5F;
  DevelopOptions options = InValues();
  options.transparent = 2000;
  options.opaque = 10000;
  options.completion = &completion;
  ThreadPool pool(1);
  const DevelopedFrame frame = Develop(plate, options, pool);
  EXPECT_EQ(frame.opacity.at(0, 0), 0.25F);   // (3/4 of 3000 + 1/4 of 7000 - 2000) / 8000
  EXPECT_EQ(frame.opacity.at(1, 0), 0.375F);  // without rays: the completion alone
  EXPECT_EQ(frame.opacity.at(2, 0), 0);       // without rays and without share: unknown
  EXPECT_EQ(frame.rgb.at(0, 0, 1), 3500);
}

// Elements that are mixed, filled and smoothed have the opacity of their red light.
TEST(Completion, OpacityIsFilledAndSmoothedLikeAColour) {
  ThreadPool pool(2);
  const Completion of_colours = RandomCompletion(false, 3),
                   with_opacity = RandomCompletion(true, 3);
  for (const uint32_t smooth_below : {0u, 4u}) {
    const SensorPlate colours = RandomPlate(kWidth, kHeight, 0.4, 6, 5);
    DevelopOptions options;
    options.smooth_below = smooth_below;
    options.completion = &of_colours;
    const DevelopedFrame plain = Develop(colours, options, pool);
    EXPECT_TRUE(plain.opacity.empty());
    options.completion = &with_opacity;
    const DevelopedFrame frame = Develop(WithRedOpacity(colours), options, pool);
    EXPECT_EQ(frame.rgb.pixels(), plain.rgb.pixels());
    EXPECT_EQ(frame.interpolated.pixels(), plain.interpolated.pixels());
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x)
        ASSERT_NEAR(frame.opacity.at(x, y), std::clamp(frame.rgb.at(x, y), 0.F, 1.F), 1e-6F);
  }
}

TEST(Completion, AThinElementWithCompletionIsNotSmoothedAndFillsOthers) {
  SensorPlate plate(3, 1, PlateKind::kOpacity);
  for (int c = 0; c < 4; ++c) {
    plate.Add(0, 0, c, {9000, 1});
    plate.Add(2, 0, c, {1000, 1});
  }
  Completion completion{Image<float>(3, 1, 3), Image<float>(3, 1), Image<float>(3, 1)};
  completion.share.at(0, 0) = 0.5F;
  completion.opacity.at(0, 0) = 7000;
  for (int c = 0; c < 3; ++c) completion.rgb.at(0, 0, c) = 7000;
  DevelopOptions options = InValues();
  options.opaque = 16000;
  options.smooth_below = 5;
  options.fill_radius_px = 1;
  options.completion = &completion;
  ThreadPool pool(1);
  const DevelopedFrame frame = Develop(plate, options, pool);
  const double values[] = {8000, 4500, 0.5 * 8000 / 2.5 + 2 * 1000 / 2.5};
  for (int x = 0; x < 3; ++x) {
    EXPECT_NEAR(frame.rgb.at(x, 0, 1), values[x], 1e-3);
    EXPECT_NEAR(frame.opacity.at(x, 0), values[x] / 16000, 1e-6);
  }
}

// The judge is the guarded frame without completion.
TEST(Completion, AGuardedElementIsMixedAfterItsGuard) {
  ThreadPool pool(2);
  const SensorPlate recorded = RandomPlate(kWidth, kHeight, 0.6, 6, 5);
  const SensorPlate all = RandomPlate(kWidth, kHeight, 0.8, 9, 8);
  for (const PlateKind kind : {PlateKind::kGuarded, PlateKind::kGuardedOpacity}) {
    const bool has_opacity = kind == PlateKind::kGuardedOpacity;
    const Completion completion = RandomCompletion(has_opacity, 3);
    for (const auto& [defocus, trust] : {std::pair{0.0, 1.0}, {0.13, 0.4}, {0.15, 1}, {1, 1}}) {
      const SensorPlate plate = GuardedOf(recorded, all, defocus, trust, kind);
      DevelopOptions options = InValues();
      options.opaque = 60000;
      const DevelopedFrame guarded = Develop(plate, options, pool);
      options.completion = &completion;
      const DevelopedFrame frame = Develop(plate, options, pool);
      EXPECT_EQ(frame.ray_count.pixels(), guarded.ray_count.pixels());
      EXPECT_EQ(frame.coverage.pixels(), guarded.coverage.pixels());
      EXPECT_EQ(frame.densified.pixels(), guarded.densified.pixels());
      EXPECT_EQ(frame.trust.pixels(), guarded.trust.pixels());
      EXPECT_EQ(frame.doubtful_count, guarded.doubtful_count);
      size_t mixed = 0, alone = 0;
      for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
          const float share = completion.share.at(x, y);
          for (int c = 0; c < 3; ++c) {
            const bool is_alone = share > 0 && guarded.ray_count.at(x, y, c) == 0;
            const double a = guarded.rgb.at(x, y, c), i = completion.rgb.at(x, y, c);
            ASSERT_NEAR(frame.rgb.at(x, y, c), is_alone ? i : (1 - share) * a + share * i, 0.02);
            mixed += share > 0 && share < 1 && !is_alone && guarded.densified.at(x, y) == 0.5F;
            alone += is_alone;
          }
          ASSERT_EQ(frame.interpolated.at(x, y),
                    share > 0 && guarded.coverage.at(x, y) == 0 ? 1 : share);
          // The opacity is the red light, divided by 60000.
          if (has_opacity) {
            ASSERT_NEAR(frame.opacity.at(x, y), std::min(frame.rgb.at(x, y, 0) / 60000, 1.F), 1e-6);
          }
        }
      EXPECT_GT(alone, 50u);
      if (defocus == 0.15) {
        EXPECT_GT(mixed, 200u);
      }
    }
  }
}

// Nothing of a frame changes that is completed by its own averages.
TEST(Completion, AFrameThatIsCompletedByItselfIsUnchanged) {
  ThreadPool pool(2);
  const SensorPlate colours = RandomPlate(kWidth, kHeight, 1, 6, 5);
  const SensorPlate more = RandomPlate(kWidth, kHeight, 1, 9, 8);
  DevelopOptions options;
  options.pedestal = 900;
  options.transparent = 4000;
  options.opaque = 60000;
  std::vector<SensorPlate> plates;
  plates.push_back(RandomPlate(kWidth, kHeight, 1, 6, 5));
  plates.push_back(WithRedOpacity(colours));
  plates.push_back(GuardedOf(colours, more, 0.2, 0.7));
  plates.push_back(GuardedOf(colours, more, 0.2, 0.7, PlateKind::kGuardedOpacity));
  for (const SensorPlate& plate : plates) {
    SCOPED_TRACE(plate.channels());
    options.completion = nullptr;
    const DevelopedFrame plain = Develop(plate, options, pool);
    Completion completion;
    if (plate.is_guarded()) {
      ASSERT_NEAR(plain.densified.at(1, 1), 0.39, 0.01);  // a mixture of both kinds of rays
      DevelopOptions in_values = options;
      in_values.pedestal = 0;
      in_values.scale = 1;
      completion = {Develop(plate, in_values, pool).rgb, RandomShares(3)};
      if (plate.has_opacity()) {
        completion.opacity = Image<float>(kWidth, kHeight);
        for (int y = 0; y < kHeight; ++y)
          for (int x = 0; x < kWidth; ++x) completion.opacity.at(x, y) = completion.rgb.at(x, y, 0);
      }
    } else {
      completion = CompletionOf(plate, RandomShares(3));
    }
    options.completion = &completion;
    const DevelopedFrame frame = Develop(plate, options, pool);
    for (size_t i = 0; i < plain.rgb.pixels().size(); ++i)
      ASSERT_NEAR(frame.rgb.pixels()[i], plain.rgb.pixels()[i], 2e-7);
    ASSERT_EQ(frame.opacity.pixels().size(), plain.opacity.pixels().size());
    for (size_t i = 0; i < plain.opacity.pixels().size(); ++i)
      ASSERT_NEAR(frame.opacity.pixels()[i], plain.opacity.pixels()[i], 2e-7);
  }
}

// A mosaic that is completed by its own means has the colours that it has without completion: the
// channels that an element lacks come from the same neighbours.
TEST(Completion, MissingChannelsAreThoseThatDevelopFills) {
  ThreadPool pool(2);
  const SensorPlate colours = RandomPlate(kWidth, kHeight, 0.1, 6, 5);
  const Image<float> shares(kWidth, kHeight, 1, 0.5F);
  DevelopOptions options;
  for (const bool has_opacity : {false, true}) {
    const SensorPlate plate =
        has_opacity ? WithRedOpacity(colours) : RandomPlate(kWidth, kHeight, 0.1, 6, 5);
    options.completion = nullptr;
    const DevelopedFrame plain = Develop(plate, options, pool);
    const Completion completion = CompletionOf(plate, shares);
    EXPECT_EQ(completion.opacity.empty(), !has_opacity);
    const Completion of_threads = CompletionOf(plate, shares, &pool);
    EXPECT_EQ(of_threads.rgb.pixels(), completion.rgb.pixels());
    EXPECT_EQ(of_threads.share.pixels(), completion.share.pixels());
    EXPECT_EQ(of_threads.opacity.pixels(), completion.opacity.pixels());
    options.completion = &completion;
    const DevelopedFrame frame = Develop(plate, options, pool);
    size_t partial = 0, incomplete = 0, empty = 0;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        int collected = 0, known = 0;  // number of channels with rays here, and near
        for (int c = 0; c < 3; ++c) {
          const auto has_ray = [&](int u, int v) { return colours.At(u, v, c).count > 0; };
          bool is_near = false;
          for (int v = std::max(0, y - 2); v < std::min(kHeight, y + 3); ++v)
            for (int u = std::max(0, x - 2); u < std::min(kWidth, x + 3); ++u)
              is_near |= has_ray(u, v) && (u - x) * (u - x) + (v - y) * (v - y) <= 4;
          collected += has_ray(x, y);
          known += is_near;
        }
        ASSERT_EQ(completion.share.at(x, y), collected > 0 && known == 3 ? 0.5F : 0)
            << x << " " << y;
        partial += collected > 0 && collected < 3 && known == 3;
        incomplete += collected > 0 && known < 3;
        empty += collected == 0;
        if (completion.share.at(x, y) == 0) continue;
        for (int c = 0; c < 3; ++c)
          ASSERT_NEAR(frame.rgb.at(x, y, c), plain.rgb.at(x, y, c), 2e-7) << x << " " << y;
        if (has_opacity) {
          ASSERT_NEAR(frame.opacity.at(x, y), plain.opacity.at(x, y), 2e-7);
        }
      }
    EXPECT_GT(partial, 100u);
    EXPECT_GT(incomplete, 50u);
    EXPECT_GT(empty, 500u);
  }
}

TEST(Completion, HasTheMeansOfThePlate) {
  SensorPlate plate(4, 1, PlateKind::kOpacity);
  for (int c = 0; c < 4; ++c) plate.Add(0, 0, c, {static_cast<uint64_t>(3 * (100 + c)), 3});
  for (int c = 0; c < 3; ++c) plate.Add(3, 0, c, {500, 1});  // the opacity is 3 elements away
  Image<float> shares(4, 1, 1, 0.75F);
  shares.at(1, 0) = 1;
  const Completion completion = CompletionOf(plate, shares);
  EXPECT_EQ(completion.share.pixels(), (LargeVector<float>{0.75F, 0, 0, 0}));
  for (int c = 0; c < 3; ++c) EXPECT_EQ(completion.rgb.at(0, 0, c), 100 + c);
  EXPECT_EQ(completion.opacity.at(0, 0), 103);
  // A share of 0 stays 0, however many rays were kept.
  EXPECT_EQ(CompletionOf(plate, Image<float>(4, 1)).share.at(0, 0), 0);
}

}  // namespace
}  // namespace lf
