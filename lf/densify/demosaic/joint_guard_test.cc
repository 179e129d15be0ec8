// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/demosaic/joint_guard.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace lf {
namespace {

constexpr int kWidth = 12 * kGuardBlock_px, kHeight = 2 * kGuardBlock_px;

// Recorded values are 0, and the LF image demosaicked by itself is 1 everywhere, in error by 1.
struct GuardCase {
  JointImage image;
  Image<float> other = Image<float>(kWidth, kHeight, 3, 1);
  Image<uint8_t> is_tested = TestedPixels(1, kWidth, kHeight);
  Image<float> tested = Image<float>(kWidth, kHeight);
  Image<float> joint = Image<float>(kWidth, kHeight, 3, 2);

  GuardCase() {
    image.pattern = BayerPattern::kRggb;
    image.samples = Image<float>(kWidth, kHeight);
    image.rgb = Image<float>(kWidth, kHeight, 3, 1);
  }
  GuardErrors Apply() { return ApplyGuard(image, other, is_tested, tested, &joint); }
};

TEST(JointGuard, AQuarterOfThePixelsIsTested) {
  const Image<uint8_t> tested = TestedPixels(5, kWidth, kHeight);
  const auto count = std::count(tested.pixels().begin(), tested.pixels().end(), 1);
  EXPECT_NEAR(static_cast<double>(count) / (kWidth * kHeight), 0.25, 0.01);
  EXPECT_NE(tested.pixels(), TestedPixels(6, kWidth, kHeight).pixels());
}

TEST(JointGuard, BetterColoursAreTaken) {
  GuardCase c;
  std::fill(c.tested.pixels().begin(), c.tested.pixels().end(), 0.5F);
  const GuardErrors errors = c.Apply();
  EXPECT_EQ(c.joint.at(40, 40, 0), 2);
  EXPECT_EQ(errors.joint_block_count, errors.block_count);
  EXPECT_EQ(errors.block_count, 24U);
  EXPECT_DOUBLE_EQ(errors.single, static_cast<double>(errors.count));
  EXPECT_DOUBLE_EQ(errors.joint, errors.single / 4);
  EXPECT_DOUBLE_EQ(errors.kept, errors.joint);
}

TEST(JointGuard, ColoursThatAreHardlyBetterAreLeft) {
  GuardCase c;
  std::fill(c.tested.pixels().begin(), c.tested.pixels().end(), 0.95F);
  const GuardErrors errors = c.Apply();
  for (const float value : c.joint.pixels()) ASSERT_EQ(value, 1);
  EXPECT_EQ(errors.joint_block_count, 0U);
  EXPECT_DOUBLE_EQ(errors.kept, errors.single);
}

TEST(JointGuard, BetweenBlocksOfBothKindsIsARamp) {
  GuardCase c;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) c.tested.at(x, y) = x < kWidth / 2 ? 0.1F : 3;
  const GuardErrors errors = c.Apply();
  EXPECT_GT(errors.joint_block_count, 0U);
  EXPECT_LT(errors.joint_block_count, errors.block_count);
  EXPECT_EQ(c.joint.at(4, 20, 1), 2);
  EXPECT_EQ(c.joint.at(kWidth - 4, 20, 1), 1);
  for (int x = 1; x < kWidth; ++x) {
    const float step = c.joint.at(x - 1, 20, 1) - c.joint.at(x, 20, 1);
    ASSERT_GE(step, 0);
    ASSERT_LE(step, 1.01F / kGuardBlock_px);
  }
}

TEST(JointGuard, MaskedPixelsAreNotTested) {
  GuardCase c;
  for (float& value : c.image.samples.pixels()) value = NAN;
  const GuardErrors errors = c.Apply();
  EXPECT_EQ(errors.count, 0U);
  EXPECT_EQ(errors.joint_block_count, 0U);
}

}  // namespace
}  // namespace lf
