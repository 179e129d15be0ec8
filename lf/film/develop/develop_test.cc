// SPDX-License-Identifier: Apache-2.0
#include "lf/film/develop/develop.h"

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
using testing::IsRecorded;
using testing::RandomPlate;
using testing::WithRedOpacity;

// Computes the formula above Develop() literally: sorts all collected elements by distance.
double BruteForce(const SensorPlate& plate, int x, int y, int channel,
                  const DevelopOptions& options) {
  const auto value = [&](const ElementSum& rays) {
    return (static_cast<double>(rays.sum) / static_cast<double>(rays.count) - options.pedestal) /
           options.scale;
  };
  const uint64_t needed = std::max<uint64_t>(options.smooth_below, 1);
  const ElementSum own = plate.At(x, y, channel);
  if (own.count >= needed) return value(own);

  const int radius = own.count > 0 ? kSmoothRadius_px : options.fill_radius_px;
  struct Neighbour {
    int distance2;
    ElementSum rays;
  };
  std::vector<Neighbour> neighbours;
  for (int v = 0; v < plate.height(); ++v)
    for (int u = 0; u < plate.width(); ++u) {
      const int distance2 = (u - x) * (u - x) + (v - y) * (v - y);
      const ElementSum rays = plate.At(u, v, channel);
      if (rays.count > 0 && distance2 <= radius * radius) neighbours.push_back({distance2, rays});
    }
  std::sort(neighbours.begin(), neighbours.end(),
            [](const Neighbour& a, const Neighbour& b) { return a.distance2 < b.distance2; });
  double sum = 0, weights = 0;
  uint64_t rays = 0, elements = 0;
  for (size_t i = 0; i < neighbours.size(); ++i) {
    const bool same_ring = i > 0 && neighbours[i].distance2 == neighbours[i - 1].distance2;
    if (!same_ring && elements >= 4 && rays >= needed) break;
    const double distance = std::sqrt(neighbours[i].distance2);
    const double weight = 1 / (distance == 0 ? 0.5 : distance);
    sum += weight * value(neighbours[i].rays);
    weights += weight;
    rays += neighbours[i].rays.count;
    ++elements;
  }
  return weights > 0 ? sum / weights : 0;
}

TEST(Develop, OpacityIsAveragedAndFilledLikeAColour) {
  ThreadPool pool(2);
  for (const uint32_t smooth_below : {0u, 4u}) {
    const SensorPlate colours = RandomPlate(50, 37, 0.4, 6, 5);
    DevelopOptions options;
    options.smooth_below = smooth_below;
    const DevelopedFrame frame = Develop(WithRedOpacity(colours), options, pool);
    const DevelopedFrame plain = Develop(colours, options, pool);
    EXPECT_EQ(frame.rgb.pixels(), plain.rgb.pixels());
    EXPECT_EQ(frame.coverage.pixels(), plain.coverage.pixels());
    EXPECT_TRUE(plain.opacity.empty());
    for (int y = 0; y < 37; ++y)
      for (int x = 0; x < 50; ++x)
        ASSERT_NEAR(frame.opacity.at(x, y), std::clamp(frame.rgb.at(x, y), 0.F, 1.F), 1e-6F);
  }
}

TEST(Develop, OpacityIsExactWhereAllRaysAgreeAndNeverOutsideOfItsRange) {
  ThreadPool pool(1);
  SensorPlate plate(4, 1, PlateKind::kOpacity);
  const uint64_t values[] = {4096, 61440, 4000, 65535};
  for (int x = 0; x < 4; ++x)
    for (int c = 0; c < 4; ++c) plate.Add(x, 0, c, {values[x] * 7, 7});
  DevelopOptions options;
  options.transparent = 4096;
  options.opaque = 61440;
  const DevelopedFrame frame = Develop(plate, options, pool);
  for (int x = 0; x < 4; ++x) EXPECT_EQ(frame.opacity.at(x, 0), static_cast<float>(x % 2));
}

// In focus, the picture has the bits of recorded LF images alone; out of focus, those of all.
TEST(Develop, AGuardedElementShowsAllRaysOnlyOutOfFocus) {
  ThreadPool pool(2);
  const SensorPlate recorded = RandomPlate(50, 37, 1, 6, 5), all = RandomPlate(50, 37, 1, 9, 8);
  DevelopOptions options;
  options.opaque = 60000;
  const DevelopedFrame of_recorded = Develop(recorded, options, pool);
  const DevelopedFrame of_all = Develop(all, options, pool);
  EXPECT_TRUE(of_all.densified.empty());
  EXPECT_TRUE(of_all.trust.empty());
  struct Case {
    double defocus, trust, share;
  };
  for (const auto& [defocus, trust, share] : {Case{0.0, 1, 0.0},
                                              {0.1, 1, 0.0},
                                              {0.15, 1, 0.5},
                                              {0.2, 1, 1.0},
                                              {1, 0.45, 1},
                                              {1, 0.375, 0.5},
                                              {0.15, 0.375, 0.25},
                                              {0.15, 0.325, 0.5 * 2 / 27},
                                              {1, 0.3, 0},
                                              {1, 0, 0},
                                              {0, 0, 0}}) {
    const DevelopedFrame frame = Develop(GuardedOf(recorded, all, defocus, trust), options, pool);
    for (int y = 0; y < 37; ++y)
      for (int x = 0; x < 50; ++x) {
        // Elements without recorded rays show all rays, even if these are not trusted.
        const double m = IsRecorded(x, y) ? share : 1;
        ASSERT_NEAR(frame.densified.at(x, y), m, 1e-6);
        // Elements in focus show recorded rays, which are trusted.
        ASSERT_NEAR(frame.trust.at(x, y), IsRecorded(x, y) && defocus <= 0.1 ? 1 : trust, 1e-6);
        for (int c = 0; c < 3; ++c) {
          const float r = of_recorded.rgb.at(x, y, c), v = of_all.rgb.at(x, y, c);
          if (m == 0) {
            ASSERT_EQ(frame.rgb.at(x, y, c), r);
          } else {
            ASSERT_NEAR(frame.rgb.at(x, y, c), r + m * (v - r), 1e-6);
          }
          ASSERT_EQ(frame.ray_count.at(x, y, c),
                    (IsRecorded(x, y) ? recorded : all).At(x, y, c).count);
        }
      }
  }
}

// The copies of several recorded LF images are not better than rays of low trust.
TEST(Develop, TrustCountsOnlyBesideASingleRecordedLfImage) {
  ThreadPool pool(2);
  const SensorPlate recorded = RandomPlate(50, 37, 1, 6, 5), all = RandomPlate(50, 37, 1, 9, 8);
  DevelopOptions options;
  options.opaque = 60000;
  for (const auto& [effective, share] : {std::pair{0.0F, 0.0},
                                         {1.0F, 0.0},
                                         {1.25F, 0.25},
                                         {1.75F, 0.75},
                                         {2.0F, 1.0},
                                         {9.0F, 1.0}}) {
    const Image<float> counts(50, 37, 1, effective);
    options.effective_count = &counts;
    const auto densified_of = [&](double defocus, double trust) {
      return Develop(GuardedOf(recorded, all, defocus, trust), options, pool).densified.at(2, 1);
    };
    EXPECT_NEAR(densified_of(1, 0.2), share, 1e-6) << effective;
    EXPECT_NEAR(densified_of(0.15, 0.2), share / 2, 1e-6) << effective;
    EXPECT_NEAR(densified_of(1, 0.5), 1, 1e-6) << effective;
    EXPECT_EQ(densified_of(0, 0.5), 0) << effective;
  }
}

TEST(Develop, TheOpacityOfAGuardedElementIsMixedLikeItsColours) {
  ThreadPool pool(2);
  const SensorPlate recorded = RandomPlate(50, 37, 1, 6, 5), all = RandomPlate(50, 37, 1, 9, 8);
  DevelopOptions options;
  options.opaque = 60000;
  options.scale = 60000;
  options.smooth_below = 4;
  for (const double defocus : {0.0, 0.13, 1.0})
    for (const double trust : {0.0, 0.4, 1.0}) {
      const SensorPlate plate =
          GuardedOf(recorded, all, defocus, trust, PlateKind::kGuardedOpacity);
      const DevelopedFrame frame = Develop(plate, options, pool);
      const DevelopedFrame plain = Develop(GuardedOf(recorded, all, defocus, trust), options, pool);
      EXPECT_EQ(frame.rgb.pixels(), plain.rgb.pixels());
      EXPECT_EQ(frame.densified.pixels(), plain.densified.pixels());
      EXPECT_EQ(frame.trust.pixels(), plain.trust.pixels());
      for (int y = 0; y < 37; ++y)
        for (int x = 0; x < 50; ++x)
          ASSERT_NEAR(frame.opacity.at(x, y), std::clamp(frame.rgb.at(x, y), 0.F, 1.F), 1e-6F);
    }
}

// Nothing of an element without any ray rests on virtual light.
TEST(Develop, AnElementOfRecordedRaysAloneShowsThem) {
  ThreadPool pool(1);
  SensorPlate plate(2, 1, PlateKind::kGuarded);
  for (int c = 0; c < 3; ++c) plate.Add(0, 0, c, {300, 1});
  plate.Add(0, 0, plate.defocus_channel(), {65535, 1});
  const DevelopedFrame frame = Develop(plate, {.scale = 1, .fill_radius_px = 0}, pool);
  EXPECT_EQ(frame.rgb.at(0, 0), 300);
  EXPECT_EQ(frame.densified.at(0, 0), 0);
  for (int x = 0; x < 2; ++x) EXPECT_EQ(frame.trust.at(x, 0), 1);
}

TEST(Develop, AgreesWithTheFormulaForAnyDensity) {
  ThreadPool pool(2);
  uint64_t seed = 1;
  for (const double density : {0.001, 0.01, 0.1, 0.5, 0.95})
    for (const uint32_t smooth_below : {0u, 1u, 3u, 40u})
      for (const int radius : {0, 1, 6, 32}) {
        const SensorPlate plate = RandomPlate(31, 22, density, 6, ++seed);
        DevelopOptions options;
        options.pedestal = 1024;
        options.scale = 60000;
        options.smooth_below = smooth_below;
        options.fill_radius_px = radius;
        const DevelopedFrame frame = Develop(plate, options, pool);
        for (int y = 0; y < plate.height(); ++y)
          for (int x = 0; x < plate.width(); ++x)
            for (int c = 0; c < 3; ++c)
              ASSERT_NEAR(frame.rgb.at(x, y, c), BruteForce(plate, x, y, c, options), 1e-6)
                  << "density " << density << " smooth " << smooth_below << " radius " << radius;
      }
}

TEST(Develop, GivesTheSameBitsForAnyThreadCount) {
  const SensorPlate plate = RandomPlate(64, 48, 0.2, 4, 5);
  DevelopOptions options;
  options.smooth_below = 5;
  const auto pixels = [&](int thread_count) {
    ThreadPool pool(thread_count);
    return Develop(plate, options, pool).rgb.pixels();
  };
  EXPECT_EQ(pixels(1), pixels(3));
}

TEST(Develop, AUniformSceneStaysUniformWhereverItHasHoles) {
  SensorPlate plate(50, 40);
  for (uint64_t i = 0; i < 700; ++i)
    for (int c = 0; c < 3; ++c)
      plate.AddRay(RandomBits(3, 0, i) % 50, RandomBits(3, 1, i) % 40, c, 13107);
  ThreadPool pool(2);
  DevelopOptions options;
  options.smooth_below = 3;
  options.fill_radius_px = 32;
  const DevelopedFrame frame = Develop(plate, options, pool);
  for (const float value : frame.rgb.pixels()) ASSERT_NEAR(value, 0.2, 1e-6);
}

TEST(Develop, LightIsNotInventedFarFromWhereItWasRecorded) {
  SensorPlate plate(41, 1);
  plate.AddRay(0, 0, 0, 65535);
  DevelopOptions options;
  options.fill_radius_px = 10;
  ThreadPool pool(1);
  const DevelopedFrame frame = Develop(plate, options, pool);
  for (int x = 0; x < 41; ++x) EXPECT_EQ(frame.rgb.at(x, 0, 0), x <= 10 ? 1 : 0);
  for (int x = 0; x < 41; ++x) EXPECT_EQ(frame.rgb.at(x, 0, 1), 0);
}

TEST(Develop, AnAddedOpacityTellsWhereLightWasRecordedOrFilled) {
  ThreadPool pool(2);
  for (const int radius_px : {0, 3}) {
    const SensorPlate plate = RandomPlate(50, 37, 0.02, 6, 5);
    DevelopOptions options;
    options.fill_radius_px = radius_px;
    options.adds_opacity = true;
    const DevelopedFrame frame = Develop(plate, options, pool);
    size_t covered = 0;
    for (int y = 0; y < 37; ++y)
      for (int x = 0; x < 50; ++x) {
        bool has_light = false;
        for (int v = std::max(0, y - radius_px); v < std::min(37, y + radius_px + 1); ++v)
          for (int u = std::max(0, x - radius_px); u < std::min(50, x + radius_px + 1); ++u)
            for (int c = 0; c < 3; ++c)
              has_light |= plate.At(u, v, c).count > 0 &&
                           (u - x) * (u - x) + (v - y) * (v - y) <= radius_px * radius_px;
        ASSERT_EQ(frame.opacity.at(x, y), has_light ? 1 : 0) << x << ", " << y;
        covered += has_light;
      }
    EXPECT_GT(covered, 50u);
    EXPECT_LT(covered, 1800u);
  }
}

TEST(Develop, AnAddedOpacityLeavesThatOfThePlateAsItIs) {
  ThreadPool pool(1);
  const SensorPlate plate = WithRedOpacity(RandomPlate(20, 10, 0.3, 6, 5));
  DevelopOptions options;
  const DevelopedFrame plain = Develop(plate, options, pool);
  options.adds_opacity = true;
  EXPECT_EQ(Develop(plate, options, pool).opacity.pixels(), plain.opacity.pixels());
}

TEST(Develop, AnAddedOpacityCountsInterpolatedLight) {
  ThreadPool pool(1);
  Completion completion{Image<float>(3, 1, 3), Image<float>(3, 1)};
  completion.share.at(1, 0) = 0.25F;
  DevelopOptions options;
  options.fill_radius_px = 0;
  options.adds_opacity = true;
  options.completion = &completion;
  const DevelopedFrame frame = Develop(SensorPlate(3, 1), options, pool);
  for (int x = 0; x < 3; ++x) EXPECT_EQ(frame.opacity.at(x, 0), x == 1 ? 1 : 0);
}

TEST(Develop, ThinElementsBorrowFromTheirNeighboursAndKeepAShare) {
  SensorPlate plate(3, 3);
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 3; ++x)
      plate.Add(x, y, 1, x == 1 && y == 1 ? ElementSum{60000, 1} : ElementSum{100 * 30000, 100});
  DevelopOptions options;
  options.scale = 1;
  options.smooth_below = 2;
  ThreadPool pool(1);
  // Four neighbours have distance 1, the element itself has weight 2: (4 * 30000 + 2 * 60000) / 6.
  EXPECT_EQ(Develop(plate, options, pool).rgb.at(1, 1, 1), 40000);
  EXPECT_EQ(Develop(plate, options, pool).rgb.at(0, 1, 1), 30000);
  options.smooth_below = 1;
  EXPECT_EQ(Develop(plate, options, pool).rgb.at(1, 1, 1), 60000);
}

TEST(Develop, CountsAndCoverageTellWhatWasCollected) {
  SensorPlate plate(2, 1);
  plate.Add(0, 0, 0, {10, 5});
  plate.Add(0, 0, 1, {10, 2});
  plate.Add(1, 0, 2, {0, uint64_t{1} << 34});
  ThreadPool pool(1);
  const DevelopedFrame frame = Develop(plate, {}, pool);
  EXPECT_EQ(frame.ray_count.pixels(), (LargeVector<uint32_t>{5, 2, 0, 0, 0, 0xffffffff}));
  EXPECT_EQ(frame.coverage.at(0, 0), 2.0f / 3);
  EXPECT_EQ(frame.coverage.at(1, 0), 1.0f / 3);
}

TEST(Develop, BalancesInTheCamerasColoursThenMixesThem) {
  SensorPlate plate(1, 1);
  for (int c = 0; c < 3; ++c) plate.AddRay(0, 0, c, static_cast<uint16_t>(1000 + 100 * (c + 1)));
  DevelopOptions options;
  options.pedestal = 1000;
  options.scale = 100;  // the radiances are 1, 2, 3
  options.white_balance = {2, 1, 4};
  options.linear_srgb_from_camera << 1, 0, 0, 0, 1, 0.5, -1, 0, 1;
  ThreadPool pool(1);
  const DevelopedFrame frame = Develop(plate, options, pool);
  EXPECT_EQ(frame.rgb.pixels(), (LargeVector<float>{2, 2 + 6, -2 + 12}));
}

TEST(Develop, ValuesBelowThePedestalStayNegative) {
  SensorPlate plate(1, 1);
  plate.AddRay(0, 0, 0, 500);
  DevelopOptions options;
  options.pedestal = 1000;
  options.scale = 1000;
  ThreadPool pool(1);
  EXPECT_EQ(Develop(plate, options, pool).rgb.at(0, 0, 0), -0.5f);
}

// Rays have the mean 3000, the completion has 7000 or 5000. The pedestal is subtracted from both.
TEST(Develop, ACompletionIsInTheUnitsOfThePlate) {
  SensorPlate plate(3, 1);
  for (int c = 0; c < 3; ++c) plate.Add(0, 0, c, {2 * 3000, 2});
  Completion completion{Image<float>(3, 1, 3), Image<float>(3, 1)};
  for (int c = 0; c < 3; ++c) {
    completion.rgb.at(0, 0, c) = 7000;
    completion.rgb.at(1, 0, c) = 5000;
  }
  completion.share.at(0, 0) = 0.25F;
  completion.share.at(1, 0) = 0.5F;
  DevelopOptions options;
  options.pedestal = 1000;
  options.scale = 2000;
  options.fill_radius_px = 0;
  options.completion = &completion;
  ThreadPool pool(1);
  const DevelopedFrame frame = Develop(plate, options, pool);
  for (int c = 0; c < 3; ++c) {
    EXPECT_EQ(frame.rgb.at(0, 0, c), 1.5F);  // (3/4 of 3000 + 1/4 of 7000 - 1000) / 2000
    EXPECT_EQ(frame.rgb.at(1, 0, c), 2.0F);  // without rays: the completion alone
    EXPECT_EQ(frame.rgb.at(2, 0, c), 0.0F);
  }
  EXPECT_EQ(frame.interpolated.pixels(), (LargeVector<float>{0.25F, 1, 0}));
}

// Only a few elements are computed between two calls of is_interrupted, so that even a slow machine
// stops soon.
TEST(Develop, AnInterruptionIsAnsweredWithinSomeElements) {
  const int width = 200, height = 40;
  const SensorPlate plate = RandomPlate(width, height, 0.4, 3, 8);
  ThreadPool pool(1);
  DevelopOptions options;
  options.smooth_below = 100;  // all elements are smoothed or filled
  int asked = 0, last = 0;
  options.is_interrupted = [&] { return ++asked == last; };
  const DevelopedFrame whole = Develop(plate, options, pool);
  const int all = asked;
  EXPECT_GE(all, (3 + 1 + 3 * width / 64) * height);
  for (const int question : {1, height / 2, 3 * height, all / 2, all}) {
    asked = 0;
    last = question;
    const DevelopedFrame frame = Develop(plate, options, pool);
    EXPECT_EQ(asked, question);  // not called again after it returned true
    EXPECT_EQ(frame.rgb.at(width - 1, height - 1, 0), 0);
  }
  EXPECT_GT(whole.rgb.at(width - 1, height - 1, 0), 0);
  options.is_interrupted = {};
  EXPECT_EQ(Develop(plate, options, pool).rgb.pixels(), whole.rgb.pixels());
}

}  // namespace
}  // namespace lf
