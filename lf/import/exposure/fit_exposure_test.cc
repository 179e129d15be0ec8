// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exposure/fit_exposure.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "lf/core/random.h"

namespace lf {
namespace {

constexpr Vignetting kTrueFalloff{{-0.3, 0.05, -0.15}};  // leaves 60 % of the light in the corner

// A strip of LF images with gains within +-20 %. Each image overlaps the next two.
struct Strip {
  explicit Strip(uint32_t count) : groups(count, 0), true_log_gains(count) {
    std::array<double, 3> sums = {};
    for (uint32_t i = 0; i < count; ++i)
      for (size_t c = 0; c < 3; ++c) {
        true_log_gains[i][c] = std::log(0.8 + 0.4 * RandomUnit(1, i, c));
        sums[c] += true_log_gains[i][c];
      }
    for (auto& gains : true_log_gains)
      for (size_t c = 0; c < 3; ++c) gains[c] -= sums[c] / count;
  }

  void AddSamples(uint32_t a, uint32_t b, uint32_t count, double noise) {
    for (uint32_t s = 0; s < count; ++s) {
      ExposureSample sample{a, b};
      const uint64_t place = samples.size();
      sample.a_r_squared = static_cast<float>(RandomUnit(2, place, 0));
      sample.b_r_squared = static_cast<float>(RandomUnit(2, place, 1));
      for (size_t c = 0; c < 3; ++c) {
        const double error = noise * (RandomUnit(3, place, c) + RandomUnit(4, place, c) - 1);
        sample.log_ratio[c] = static_cast<float>(
            ModelLogRatio(sample, static_cast<int>(c), true_log_gains, groups, {kTrueFalloff}) +
            error);
      }
      samples.push_back(sample);
    }
  }

  std::vector<uint32_t> groups;
  std::vector<std::array<double, 3>> true_log_gains;
  std::vector<ExposureSample> samples;
};

double WorstGain(const ExposureFit& fit, const Strip& strip) {
  double worst = 0;
  for (size_t i = 0; i < strip.groups.size(); ++i)
    for (size_t c = 0; c < 3; ++c)
      worst =
          std::max(worst, std::abs(std::expm1(fit.log_gains[i][c] - strip.true_log_gains[i][c])));
  return worst;
}

double WorstFalloff(const ExposureFit& fit) {
  double worst = 0;
  for (int i = 0; i <= 20; ++i)
    worst = std::max(
        worst, std::abs(fit.falloffs[0].Falloff(i / 20.) / kTrueFalloff.Falloff(i / 20.) - 1));
  return worst;
}

TEST(FitExposure, GainsAndFalloffAreExactWithoutNoise) {
  Strip strip(12);
  for (uint32_t i = 0; i + 2 < 12; ++i)
    for (const uint32_t step : {1U, 2U}) strip.AddSamples(i, i + step, 30, 0);
  const ExposureFit fit =
      FitExposure(strip.samples, strip.groups, {Vignetting()}, {.vignetting = true});
  EXPECT_LT(WorstGain(fit, strip), 1e-4);
  EXPECT_LT(WorstFalloff(fit), 1e-4);
  EXPECT_EQ(fit.component_count, 1u);
  EXPECT_LT(fit.step, 1e-4);
}

TEST(FitExposure, AThirdOfSamplesMayBeOfSomethingElse) {
  Strip strip(12);
  for (uint32_t i = 0; i + 2 < 12; ++i)
    for (const uint32_t step : {1U, 2U}) strip.AddSamples(i, i + step, 150, 0.01);
  for (size_t i = 0; i < strip.samples.size(); i += 3)
    for (float& ratio : strip.samples[i].log_ratio)
      ratio = 0;  // a watermark is equally bright in both images
  const ExposureFit fit =
      FitExposure(strip.samples, strip.groups, {Vignetting()}, {.vignetting = true});
  EXPECT_LT(WorstGain(fit, strip), 0.005);
  EXPECT_LT(WorstFalloff(fit), 0.005);
}

TEST(FitExposure, AKnownFalloffIsTakenAsItIs) {
  Strip strip(6);
  for (uint32_t i = 0; i + 1 < 6; ++i) strip.AddSamples(i, i + 1, 30, 0);
  const ExposureFit fit = FitExposure(strip.samples, strip.groups, {kTrueFalloff}, {});
  EXPECT_EQ(fit.falloffs[0], kTrueFalloff);
  EXPECT_LT(WorstGain(fit, strip), 1e-4);
}

TEST(FitExposure, EachComponentHasTheMeanOne) {
  Strip strip(8);
  for (const uint32_t i : {0U, 1U, 4U, 5U}) strip.AddSamples(i, i + 1, 30, 0);
  const ExposureFit fit = FitExposure(strip.samples, strip.groups, {kTrueFalloff}, {});
  EXPECT_EQ(fit.component_count, 2u);
  EXPECT_EQ(fit.components[0], fit.components[2]);
  EXPECT_NE(fit.components[0], fit.components[4]);
  EXPECT_EQ(fit.components[3], kAlone);
  EXPECT_EQ(fit.components[7], kAlone);
  for (size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(fit.log_gains[0][c] + fit.log_gains[1][c] + fit.log_gains[2][c], 0, 1e-9);
    EXPECT_NEAR(fit.log_gains[4][c] + fit.log_gains[5][c] + fit.log_gains[6][c], 0, 1e-9);
    EXPECT_EQ(fit.log_gains[3][c], 0);
    EXPECT_NEAR(fit.log_gains[1][c] - fit.log_gains[0][c],
                strip.true_log_gains[1][c] - strip.true_log_gains[0][c], 1e-4);
  }
}

TEST(FitExposure, AFewSamplesDoNotTieAnImage) {
  Strip strip(3);
  strip.AddSamples(0, 1, 30, 0);
  strip.AddSamples(1, 2, 3, 0);
  EXPECT_EQ(FitExposure(strip.samples, strip.groups, {kTrueFalloff}, {}).components[2], kAlone);
}

TEST(FitExposure, PlacesThatDifferFromEachOtherTieNoImage) {
  for (const double noise : {0.02, 0.5}) {
    Strip strip(12);
    for (uint32_t i = 0; i + 2 < 12; ++i)
      for (const uint32_t step : {1U, 2U}) strip.AddSamples(i, i + step, 30, noise);
    const ExposureFit fit = FitExposure(strip.samples, strip.groups, {kTrueFalloff}, {});
    EXPECT_NEAR(fit.spread, 0.44 * noise, 0.05 * noise);  // 1.48 x median |x| of triangular noise x
    EXPECT_EQ(fit.component_count, noise < 0.1 ? 1u : 0u);
    EXPECT_EQ(std::count(fit.components.begin(), fit.components.end(), kAlone),
              noise < 0.1 ? 0 : 12);
  }
}

TEST(FitExposure, ChannelsWithoutSamplesKeepTheirGain) {
  Strip strip(3);
  for (const uint32_t i : {0U, 1U}) strip.AddSamples(i, i + 1, 30, 0);
  for (ExposureSample& sample : strip.samples)
    sample.log_ratio[2] = std::numeric_limits<float>::quiet_NaN();
  const ExposureFit fit = FitExposure(strip.samples, strip.groups, {kTrueFalloff}, {});
  EXPECT_NEAR(fit.log_gains[1][2], 0, 1e-9);
  EXPECT_EQ(fit.sample_count, 120u);
}

TEST(FitExposure, NothingIsFoundInNoSamples) {
  const ExposureFit fit = FitExposure({}, {0, 0}, {Vignetting()}, {.vignetting = true});
  EXPECT_EQ(fit.component_count, 0u);
  EXPECT_EQ(fit.falloffs[0], Vignetting());
}

}  // namespace
}  // namespace lf
