// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exposure/match_exposure.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "lf/core/random.h"
#include "lf/core/test_value_noise.h"
#include "lf/focus/focus_pick.h"

namespace lf {
namespace {

constexpr int kWidth = 240, kHeight = 160;
constexpr double kFocal_px = 220, kPitch_w = 0.05, kWall_w = 2;
constexpr Vignetting kLensFalloff{{-0.3, 0.05, -0.15}};  // leaves 60 % of the light in the corner

// A grid of unevenly exposed cameras in front of a textured wall, with the falloff of their lens
// and noise.
class UnevenStore : public LfImageStore {
 public:
  explicit UnevenStore(int side = 5) {
    field.encoding.transfer = Transfer::kLinear;
    Intrinsics k;
    k.fx_px = k.fy_px = kFocal_px;
    k.cx_px = kWidth / 2.;
    k.cy_px = kHeight / 2.;
    k.width_px = kWidth;
    k.height_px = kHeight;
    field.intrinsics = {k};
    for (int i = 0; i < side * side; ++i) {
      LfCamera camera;
      camera.cam_from_world.translation =
          -Vec3(kPitch_w * (i % side - side / 2), kPitch_w * (i / side - side / 2), 0);
      field.cameras.push_back(camera);
      field.image_names.push_back("drawn_" + std::to_string(i) + ".png");
      std::array<double, 3> exposure;
      for (size_t c = 0; c < 3; ++c)
        exposure[c] = 0.8 + 0.4 * RandomUnit(1, static_cast<uint64_t>(i), c);
      exposures.push_back(exposure);
    }
  }

  Result<void> Load(LfImageId id, const PixelRect& rect, LfPixels* pixels) const override {
    if (id == broken) return InputError("drawn.png: not found");
    const PinholeCamera camera = field.Camera(id);
    pixels->Reset(rect, BayerPattern::kNone);
    for (int y = 0; y < rect.height(); ++y)
      for (int x = 0; x < rect.width(); ++x) {
        const Vec2 at(rect.x_begin + x + 0.5, rect.y_begin + y + 0.5);
        const Ray ray = *RayOfLfPixel(camera, at.x(), at.y());
        const Vec3 point = ray.At((kWall_w - ray.origin.z()) / ray.direction.z());
        const double scale = kFocal_px / 8 / kWall_w;
        const double grey = 0.4 * ValueNoise(point.x() * scale, point.y() * scale, 5);
        for (size_t c = 0; c < 3; ++c) {
          double light =
              is_blank ? 0.3
                       : 0.1 + grey + 0.1 * ValueNoise(point.x() * scale, point.y() * scale, 6 + c);
          if (has_windows && ValueNoise(point.x() * 3, point.y() * 3, 8) > 0.7) light = 2;
          light *= exposures[id.value][c] *
                   falloff.Falloff(RadiusSquared(camera.intrinsics, at.x(), at.y()));
          const uint64_t place = (id.value * 1000ull + static_cast<uint64_t>(at.y())) * 1000 +
                                 static_cast<uint64_t>(at.x());
          light += 0.02 * (RandomUnit(2, place, c) - 0.5);
          if (has_watermark && at.x() > 150 && at.y() > 110)
            light = 0.2 + 0.6 * ValueNoise(at.x() / 4, at.y() / 4, 9);
          pixels->radiance.at(x, y, static_cast<int>(c)) =
              static_cast<uint16_t>(std::lround(65535 * std::clamp(light, 0., 1.)));
        }
        pixels->radiance.at(x, y, LfPixels::kRayLane) = 1;
      }
    return {};
  }

  LightField field;
  std::vector<std::array<double, 3>> exposures;
  Vignetting falloff = kLensFalloff;
  bool has_watermark = false, has_windows = false, is_blank = false;
  LfImageId broken{1000000};
};

// Returns the largest relative error of a gain, up to a factor that all gains have in common.
double WorstMatchedGain(const MatchedExposure& matched, const UnevenStore& store) {
  double worst = 0;
  for (size_t c = 0; c < 3; ++c) {
    double sum = 0;
    for (size_t i = 0; i < store.field.size(); ++i)
      sum += std::log(matched.gains[i][c] * store.exposures[i][c]);
    const double scale = std::exp(sum / static_cast<double>(store.field.size()));
    for (size_t i = 0; i < store.field.size(); ++i)
      worst = std::max(worst, std::abs(matched.gains[i][c] * store.exposures[i][c] / scale - 1));
  }
  return worst;
}

double WorstMatchedFalloff(const MatchedExposure& matched) {
  double worst = 0;
  for (int i = 0; i <= 20; ++i)
    worst = std::max(
        worst, std::abs(matched.falloffs[0].Falloff(i / 20.) / kLensFalloff.Falloff(i / 20.) - 1));
  return worst;
}

Result<MatchedExposure> Match(const UnevenStore& store, bool vignetting = true) {
  ThreadPool pool(2);
  MatchExposureOptions options;
  options.vignetting = vignetting;
  return MatchExposure(store.field, store, options, pool);
}

TEST(MatchExposure, GainsAndFalloffAreRestoredToHalfAPercent) {
  UnevenStore store;
  store.has_watermark = true;
  const Result<MatchedExposure> matched = Match(store);
  ASSERT_TRUE(matched) << matched.error().message;
  EXPECT_LT(WorstMatchedGain(*matched, store), 0.005);
  EXPECT_LT(WorstMatchedFalloff(*matched), 0.005);
  ASSERT_TRUE(matched->falloff);
  EXPECT_NEAR(matched->falloff->corner_min, 0.6, 0.003);
  EXPECT_GT(matched->step_before, 0.1);
  EXPECT_LT(matched->step_after, 0.01);
  EXPECT_EQ(matched->component_count, 1u);
  EXPECT_TRUE(matched->left_alone.empty());
}

TEST(MatchExposure, ClippedLightTellsNothing) {
  UnevenStore store;
  store.has_windows = true;
  const Result<MatchedExposure> matched = Match(store);
  ASSERT_TRUE(matched) << matched.error().message;
  EXPECT_LT(WorstMatchedGain(*matched, store), 0.005);
  EXPECT_LT(WorstMatchedFalloff(*matched), 0.01);
}

TEST(MatchExposure, AFalloffThatIsStatedIsKept) {
  UnevenStore store(4);
  store.field.intrinsics[0].vignetting = kLensFalloff;
  const Result<MatchedExposure> matched = Match(store, false);
  ASSERT_TRUE(matched) << matched.error().message;
  EXPECT_EQ(matched->falloffs[0], kLensFalloff);
  EXPECT_FALSE(matched->falloff);
  EXPECT_LT(WorstMatchedGain(*matched, store), 0.005);
}

TEST(MatchExposure, AnEvenCaptureStaysAsItIs) {
  UnevenStore store(4);
  for (auto& exposure : store.exposures) exposure = {1, 1, 1};
  store.falloff = {};
  const Result<MatchedExposure> matched = Match(store);
  ASSERT_TRUE(matched) << matched.error().message;
  EXPECT_GT(matched->least_gain, 0.995f);
  EXPECT_LT(matched->most_gain, 1.005f);
  EXPECT_NEAR(matched->falloff->corner_min, 1, 0.005);
  EXPECT_LT(matched->step_before, 0.01);
}

TEST(MatchExposure, WhatCannotBeReadOrComparedIsLeftAlone) {
  UnevenStore store(4);
  store.broken = LfImageId{7};
  store.field.cameras[7].gain = 2;
  // Camera 3 looks away.
  store.field.cameras[3].cam_from_world.rotation = Vec3(-1, 1, -1).asDiagonal();
  store.field.cameras[3].gain = 3;
  const Result<MatchedExposure> matched = Match(store);
  ASSERT_TRUE(matched) << matched.error().message;
  ASSERT_EQ(matched->unreadable.size(), 1u);
  EXPECT_EQ(matched->unreadable[0], LfImageId{7});
  ASSERT_EQ(matched->left_alone.size(), 1u);
  EXPECT_EQ(matched->left_alone[0], LfImageId{3});
  EXPECT_EQ(matched->gains[7][0], 2);
  EXPECT_EQ(matched->gains[3][0], 3);
}

TEST(MatchExposure, AWallWithoutTextureIsRefused) {
  UnevenStore store;
  store.is_blank = true;
  store.falloff = {};
  const Result<MatchedExposure> matched = Match(store);
  ASSERT_FALSE(matched);
  EXPECT_NE(matched.error().message.find("texture"), std::string::npos);
}

TEST(MatchExposure, CopiesThatDoNotFitIntoTheMemoryAreRefused) {
  UnevenStore store;
  ThreadPool pool(1);
  MatchExposureOptions options;
  options.memory_bytes = 1000;
  EXPECT_FALSE(MatchExposure(store.field, store, options, pool));
}

TEST(ApplyExposure, RecordedLightIsNotClippedByIt) {
  UnevenStore store;
  MatchedExposure matched;
  matched.gains.assign(store.field.size(), ChannelGains(1, 1.2f, 0.9f));
  matched.falloffs = {kLensFalloff};
  ApplyExposure(matched, &store.field);
  EXPECT_EQ(store.field.cameras[2].gain[1], 1.2f);
  EXPECT_EQ(store.field.intrinsics[0].vignetting, kLensFalloff);
  EXPECT_GE(store.field.encoding.max_radiance, 1.2 / 0.6 - 1e-6);
  EXPECT_LE(store.field.encoding.max_radiance, 1.2 / 0.6 + 0.011);
  store.field.image_names[0] = "drawn.exr";
  store.field.encoding.max_radiance = 16;
  ApplyExposure(matched, &store.field);
  EXPECT_EQ(store.field.encoding.max_radiance, 16);
}

}  // namespace
}  // namespace lf
