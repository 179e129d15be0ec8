// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/synthetic/pattern.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "lf/core/random.h"

namespace lf {
namespace {

constexpr std::array kKinds = {PatternKind::kPlain,   PatternKind::kChecker, PatternKind::kBars,
                               PatternKind::kLetters, PatternKind::kStar,    PatternKind::kWood,
                               PatternKind::kSwirl};

TEST(Pattern, EveryPatternStaysBetweenItsTwoColours) {
  for (const PatternKind kind : kKinds)
    for (uint64_t i = 0; i < 2000; ++i) {
      const Vec2 place(RandomUnit(1, 0, i) - 0.5, RandomUnit(1, 1, i) - 0.5);
      const double value = PatternAt({kind, 0.03, 5}, place, 0.05 * RandomUnit(1, 2, i));
      EXPECT_GE(value, -1e-12);
      EXPECT_LE(value, 1 + 1e-12);
    }
}

TEST(Pattern, FieldsOfACheckerAlternate) {
  const Pattern checker{PatternKind::kChecker, 0.1, 0};
  EXPECT_EQ(PatternAt(checker, {0.05, 0.05}, 0), 1);
  EXPECT_EQ(PatternAt(checker, {0.15, 0.05}, 0), 0);
  EXPECT_EQ(PatternAt(checker, {-0.05, 0.05}, 0), 0);
  EXPECT_EQ(PatternAt(checker, {-0.05, -0.05}, 0), 1);
}

// The analytic filter must equal the mean over the width.
TEST(Pattern, AWideFootprintSeesTheMeanOfABar) {
  const Pattern bars{PatternKind::kBars, 0.01, 0};
  for (const double width_w : {0.003, 0.008, 0.013, 0.05})
    for (const double x_w : {0.0, 0.0042, 0.0101, 0.017}) {
      double mean = 0;
      constexpr int kSteps = 2000;
      for (int i = 0; i < kSteps; ++i)
        mean += PatternAt(bars, {x_w + width_w * ((i + 0.5) / kSteps - 0.5), -0.01}, 0) / kSteps;
      EXPECT_NEAR(PatternAt(bars, {x_w, -0.01}, width_w), mean, 2e-3);
    }
}

TEST(Pattern, BarsBecomeFinerRowByRow) {
  const Pattern bars{PatternKind::kBars, 0.01, 0};
  const auto changes = [&bars](double y_w) {
    int count = 0;
    for (int i = 1; i < 10000; ++i)
      count += PatternAt(bars, {i * 1e-4, y_w}, 0) != PatternAt(bars, {(i - 1) * 1e-4, y_w}, 0);
    return count;
  };
  EXPECT_NEAR(changes(-0.02), 100, 1);   // 1 m of 1 cm bars
  EXPECT_NEAR(changes(-0.095), 125, 1);  // the next row: 0.075 lower, 4/5 as wide
}

TEST(Pattern, TheStarHasThirtySixPeriodsAndAGreyHeart) {
  const Pattern star{PatternKind::kStar, 0.1, 0};
  int rises = 0;
  constexpr int kSteps = 3600;
  const auto at = [&star](int i) {
    const double angle = 2 * kPi * (i + 0.5) / kSteps;
    return PatternAt(star, 0.05 * Vec2(std::cos(angle), std::sin(angle)), 0);
  };
  for (int i = 0; i < kSteps; ++i) rises += at(i) < 0.5 && at(i + 1) >= 0.5;
  EXPECT_EQ(rises, 36);
  EXPECT_EQ(PatternAt(star, {0.001, 0.0003}, 0.002), 0.5);
}

TEST(Pattern, NoiseIsSmoothAndTheSameEverywhere) {
  double sum = 0;
  for (uint64_t i = 0; i < 4000; ++i) {
    const double x = 100 * RandomUnit(2, 0, i) - 50, y = 100 * RandomUnit(2, 1, i) - 50;
    const double value = ValueNoise(x, y, 9);
    EXPECT_EQ(value, ValueNoise(x, y, 9));
    EXPECT_NEAR(ValueNoise(x + 1e-4, y, 9), value, 5e-4);
    sum += value;
  }
  EXPECT_NEAR(sum / 4000, 0.5, 0.02);
}

}  // namespace
}  // namespace lf
