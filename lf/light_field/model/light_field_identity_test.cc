// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/model/light_field_identity.h"

#include <gtest/gtest.h>

#include "lf/light_field/model/value_hasher.h"

namespace lf {
namespace {

LightField OneCamera(const Distortion& distortion) {
  LightField light_field;
  light_field.cameras.resize(1);
  light_field.image_names = {"a.png"};
  light_field.intrinsics = {{500, 501, 320, 240, 0.5, 640, 480, distortion}};
  return light_field;
}

// Checkpoints and packages that were written before the model with twelve parameters existed
// contain hashes of eight parameters.
TEST(LightFieldIdentity, ALensOfAnOlderModelIsHashedByEightParameters) {
  ValueHasher expected;
  for (const double number : {1, 0, 0, 0, 1, 0, 0, 0, 1}) expected.Add(number);  // rotation
  for (const double number : {0, 0, 0}) expected.Add(number);
  for (const double number : {0, 1}) expected.Add(number);  // intrinsics_index, gain
  for (const double number : {500.0, 501.0, 320.0, 240.0, 0.5, 640.0, 480.0}) expected.Add(number);
  for (const double number : {2, 1, 2, 3, 4, 0, 0, 0, 0}) expected.Add(number);  // lens distortion
  EXPECT_EQ(IdentityOf(OneCamera({DistortionModel::kFisheye, {1, 2, 3, 4}})).calibration,
            expected.Text());
}

TEST(LightFieldIdentity, EveryParameterOfALensCounts) {
  const Distortion lens = {DistortionModel::kRadialTangentialThinPrism, {}};
  for (size_t i = 0; i < lens.parameters.size(); ++i) {
    Distortion other = lens;
    other.parameters[i] = 1e-9;
    EXPECT_NE(IdentityOf(OneCamera(other)), IdentityOf(OneCamera(lens))) << i;
  }
}

TEST(LightFieldIdentity, MarksOfVirtualImagesCount) {
  LightField recorded;
  recorded.cameras.resize(3);
  recorded.image_names = {"a.png", "b.png", "c.png"};
  EXPECT_FALSE(HasVirtual(recorded));
  EXPECT_EQ(RecordedCount(recorded), 3u);
  LightField second = recorded, third = recorded;
  second.cameras[1].is_virtual = true;
  third.cameras[2].is_virtual = true;
  EXPECT_TRUE(HasVirtual(second));
  EXPECT_EQ(RecordedCount(second), 2u);
  EXPECT_NE(IdentityOf(recorded), IdentityOf(second));
  EXPECT_NE(IdentityOf(recorded), IdentityOf(third));
  EXPECT_NE(IdentityOf(second), IdentityOf(third));
  EXPECT_EQ(IdentityOf(recorded).names, IdentityOf(second).names);
}

}  // namespace
}  // namespace lf
