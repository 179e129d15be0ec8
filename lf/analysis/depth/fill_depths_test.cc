// SPDX-License-Identifier: Apache-2.0
#include "lf/analysis/depth/fill_depths.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace lf {
namespace {

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

TEST(FillDepths, KnownValuesStayAndUnknownOnesLieBetweenThem) {
  Image<float> values(37, 21, 1, kUnknown);
  const Image<float> weights(37, 21, 1, 0.5f);
  values.at(3, 4) = 2;
  values.at(30, 17) = 6;
  const Image<float> filled = FilledDepths(values, weights, 9);
  EXPECT_EQ(filled.at(3, 4), 2);
  EXPECT_EQ(filled.at(30, 17), 6);
  for (const float value : filled.pixels()) {
    EXPECT_GE(value, 2);
    EXPECT_LE(value, 6);
  }
  EXPECT_LT(filled.at(4, 4), 3);
  EXPECT_GT(filled.at(29, 17), 5);
}

TEST(FillDepths, EqualValuesStayEqual) {
  Image<float> values(20, 9, 1, kUnknown);
  Image<float> weights(20, 9, 1, 0.1f);
  for (int x = 0; x < 20; x += 3) {
    values.at(x, 5) = 1.5f;
    weights.at(x, 5) = 0.3f + 0.01f * static_cast<float>(x);
  }
  const Image<float> filled = FilledDepths(values, weights, 9);
  for (const float value : filled.pixels()) EXPECT_NEAR(value, 1.5, 1e-6);
}

TEST(FillDepths, WithoutAnyKnownValueAllAreTheOther) {
  const Image<float> filled =
      FilledDepths(Image<float>(5, 3, 1, kUnknown), Image<float>(5, 3, 1, 1), 9);
  for (const float value : filled.pixels()) EXPECT_EQ(value, 9);
  EXPECT_EQ(FilledDepths(Image<float>(1, 1, 1, 4), Image<float>(1, 1, 1, 1), 9).at(0, 0), 4);
}

}  // namespace
}  // namespace lf
