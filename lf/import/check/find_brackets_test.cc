// SPDX-License-Identifier: Apache-2.0
#include "lf/import/check/find_brackets.h"

#include <gtest/gtest.h>

#include <limits>

namespace lf {
namespace {

LightField Field(const std::vector<float>& gains) {
  LightField field;
  for (const float gain : gains) {
    field.cameras.emplace_back();
    field.cameras.back().gain = gain;
  }
  return field;
}

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

TEST(FindBrackets, GainsTellTheExposures) {
  const LightField field = Field({1, 4, 0.25F, 1, 4, 0.25F, 1});
  const auto found = FindBrackets(field, std::vector<uint32_t>{0, 0, 0, 3, 3, 3, 6}, {});
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->are_gains);
  EXPECT_EQ(found->pose_count, 2U);
  EXPECT_EQ(found->image_count, 6U);
  EXPECT_EQ(found->least_exposures, 3U);
  EXPECT_EQ(found->most_exposures, 3U);
  EXPECT_EQ(found->stops, (std::vector<double>{-2, 0, 2}));
  EXPECT_EQ(found->of_images, (std::vector<bool>{true, true, true, true, true, true, false}));
}

TEST(FindBrackets, FilesTellTheExposuresWhereGainsDoNot) {
  const LightField field = Field({1, 1, 1, 1, 1});
  const std::vector<uint32_t> firsts = {0, 0, 2, 2, 2};
  EXPECT_FALSE(FindBrackets(field, firsts, {}));
  const std::vector<double> lights = {0.01, 0.04, 0.01, 0.0025, kUnknown};
  const auto found = FindBrackets(field, firsts, lights);
  ASSERT_TRUE(found);
  EXPECT_FALSE(found->are_gains);
  EXPECT_EQ(found->pose_count, 2U);
  EXPECT_EQ(found->most_exposures, 2U);
  EXPECT_EQ(found->stops, (std::vector<double>{0, 2}));
}

TEST(FindBrackets, ImagesListedTwiceAreNone) {
  const LightField field = Field({1, 1, 1.05F});
  const std::vector<uint32_t> firsts = {0, 0, 0};
  EXPECT_FALSE(FindBrackets(field, firsts, std::vector<double>{0.01, 0.01, 0.01}));
  EXPECT_FALSE(FindBrackets(field, firsts, std::vector<double>{0.01, kUnknown, kUnknown}));
}

TEST(FindBrackets, PosesMayHaveDifferentlyMany) {
  const LightField field = Field({1, 4, 1, 2, 8});
  const auto found = FindBrackets(field, std::vector<uint32_t>{0, 0, 2, 2, 2}, {});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->least_exposures, 2U);
  EXPECT_EQ(found->most_exposures, 3U);
  ASSERT_EQ(found->stops.size(), 3U);
  EXPECT_NEAR(found->stops[0], -2, 1e-12);
  EXPECT_EQ(found->stops[1], 0);
  EXPECT_NEAR(found->stops[2], 1, 1e-12);
}

}  // namespace
}  // namespace lf
