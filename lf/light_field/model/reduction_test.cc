// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/model/reduction.h"

#include <gtest/gtest.h>

#include "lf/light_field/model/light_field.h"
#include "lf/light_field/model/light_field_identity.h"

namespace lf {
namespace {

LightField TwoCameras() {
  LightField field;
  field.intrinsics = {{100, 102, 40, 30, 1, 81, 61}, {50, 50, 20, 15, 0, 5, 30}};
  field.cameras.resize(2);
  field.cameras[1].intrinsics_index = 1;
  field.image_names = {"a.png", "b.png"};
  field.encoding.bayer = BayerPattern::kRggb;
  return field;
}

TEST(Reduction, PixelsBecomeLargerForTheSamePicture) {
  LightField field = TwoCameras();
  ASSERT_TRUE(ReduceLightField(4, &field));
  EXPECT_EQ(field.intrinsics[0].width_px, 20);
  EXPECT_EQ(field.intrinsics[0].height_px, 15);
  EXPECT_DOUBLE_EQ(field.intrinsics[0].fx_px, 25);
  EXPECT_DOUBLE_EQ(field.intrinsics[0].cy_px, 7.5);
  EXPECT_EQ(field.intrinsics[1].width_px, 1);
  EXPECT_EQ(field.encoding.bayer, BayerPattern::kNone);
  EXPECT_EQ(field.encoding.footprint, PixelFootprint::kArea);
}

TEST(Reduction, TheLargerDivisorCountsAndIsUndone) {
  const LightField whole = TwoCameras();
  LightField twice = whole, once = whole;
  ASSERT_TRUE(ReduceLightField(1, &twice));
  EXPECT_FALSE(twice.reduction);
  ASSERT_TRUE(ReduceLightField(2, &twice));
  ASSERT_TRUE(ReduceLightField(8, &twice));
  ASSERT_TRUE(ReduceLightField(4, &twice));
  ASSERT_TRUE(ReduceLightField(8, &once));
  EXPECT_EQ(IdentityOf(twice), IdentityOf(once));
  EXPECT_NE(IdentityOf(twice), IdentityOf(whole));
  const LightField recorded = RecordedLightField(twice);
  EXPECT_EQ(IdentityOf(recorded), IdentityOf(whole));
  EXPECT_EQ(recorded.encoding.bayer, BayerPattern::kRggb);
  EXPECT_FALSE(recorded.reduction);
}

TEST(Reduction, WhatCannotBeReducedIsRefused) {
  LightField field = TwoCameras();
  EXPECT_EQ(ReduceLightField(3, &field).error().kind, ErrorKind::kUsage);
  EXPECT_EQ(ReduceLightField(16, &field).error().kind, ErrorKind::kUsage);
  EXPECT_TRUE(CheckNotReduced(field, "a test"));
  LightField densified = field;
  densified.cameras[1].is_virtual = true;
  EXPECT_EQ(ReduceLightField(2, &densified).error().kind, ErrorKind::kUsage);
  EXPECT_FALSE(densified.reduction);
  ASSERT_TRUE(ReduceLightField(2, &field));
  EXPECT_EQ(CheckNotReduced(field, "a test").error().kind, ErrorKind::kUsage);
}

}  // namespace
}  // namespace lf
