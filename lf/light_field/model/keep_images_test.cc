// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/model/keep_images.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace lf {
namespace {

LightField SixCameras() {
  LightField field;
  for (uint32_t i = 0; i < 6; ++i) {
    field.cameras.emplace_back().intrinsics_index = i;
    field.image_names.push_back(std::to_string(i));
    field.mask_names.push_back("mask " + std::to_string(i));
    field.times.push_back(10 * i);
  }
  return field;
}

TEST(KeepImages, KeepsCamerasNamesAndMasksTogether) {
  LightField field = SixCameras();
  const std::vector<size_t> kept = {0, 3, 5};
  KeepImages(kept, &field);
  ASSERT_EQ(field.size(), 3u);
  EXPECT_EQ(field.image_names, (std::vector<std::string>{"0", "3", "5"}));
  EXPECT_EQ(field.mask_names, (std::vector<std::string>{"mask 0", "mask 3", "mask 5"}));
  EXPECT_EQ(field.times, (std::vector<double>{0, 30, 50}));
  for (size_t i = 0; i < 3; ++i) EXPECT_EQ(field.cameras[i].intrinsics_index, kept[i]);
}

TEST(KeepImages, TheRecordedPartHasNoVirtualImages) {
  LightField field = SixCameras();
  field.mask_names.clear();
  field.cameras[1].is_virtual = field.cameras[4].is_virtual = true;
  const LightField recorded = RecordedPart(field);
  EXPECT_EQ(recorded.image_names, (std::vector<std::string>{"0", "2", "3", "5"}));
  EXPECT_FALSE(HasVirtual(recorded));
  EXPECT_TRUE(recorded.mask_names.empty());
}

}  // namespace
}  // namespace lf
