// SPDX-License-Identifier: Apache-2.0
// Tests LfImageStore::LoadReduced() of files.
#include <gtest/gtest.h>

#include <utility>

#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/test_folder.h"
#include "lf/storage/load/folder_store.h"

namespace lf {
namespace {

using ReducedLoadTest = FolderTest;

// A JPEG file is reduced by a power of two that divides the divisor; its falloff is undone at the
// same places. Other files are loaded whole.
TEST_F(ReducedLoadTest, JpegFilesAreReduced) {
  constexpr int kLong = 40;
  Image<uint8_t> smooth(kLong, kLong, 3);
  for (int y = 0; y < kLong; ++y)
    for (int x = 0; x < kLong; ++x)
      for (int c = 0; c < 3; ++c) smooth.at(x, y, c) = static_cast<uint8_t>(60 + 2 * x + y + 9 * c);
  for (const char* name : {"a.jpg", "a.png"})
    ASSERT_TRUE(WriteImage(folder_ / name, smooth.view()));
  LightField field;
  field.cameras.resize(1);
  field.image_names = {"a.jpg"};
  field.folder = folder_;
  field.intrinsics = {{30, 30, 20, 20, 0, kLong, kLong}};
  field.intrinsics[0].vignetting = {{-0.3, 0, 0}};
  LfPixels whole;
  ASSERT_TRUE(FolderStore(field).Load({0}, {0, 0, kLong, kLong}, &whole));
  for (const auto& [divisor, reduction] :
       {std::pair(1, 1), {2, 2}, {3, 1}, {6, 2}, {12, 4}, {16, 8}}) {
    LfPixels pixels;
    const auto reduced = FolderStore(field).LoadReduced({0}, divisor, field.intrinsics[0], &pixels);
    ASSERT_TRUE(reduced);
    EXPECT_EQ(*reduced, reduction);
    ASSERT_EQ(pixels.rect, (PixelRect{0, 0, kLong / reduction, kLong / reduction}));
    for (int y = 0; y < pixels.rect.height(); ++y)
      for (int x = 0; x < pixels.rect.width(); ++x) {
        double mean = 0;
        for (int i = 0; i < reduction * reduction; ++i)
          mean +=
              whole.radiance.at(x * reduction + i % reduction, y * reduction + i / reduction, 1);
        mean /= reduction * reduction;
        EXPECT_NEAR(pixels.radiance.at(x, y, 1), mean, 0.03 * mean + 300) << divisor;
      }
  }
  LfPixels pixels;
  field.image_names = {"a.png"};
  EXPECT_EQ(*FolderStore(field).LoadReduced({0}, 8, field.intrinsics[0], &pixels), 1);
  EXPECT_EQ(pixels.rect.width(), kLong);
  field.image_names = {"a.jpg"};
  field.mask_names = {"mask.png"};
  EXPECT_FALSE(FolderStore(field).LoadReduced({0}, 8, field.intrinsics[0], &pixels));  // no mask
  field.mask_names.clear();
  field.intrinsics[0].width_px = 99;
  EXPECT_FALSE(FolderStore(field).LoadReduced({0}, 8, field.intrinsics[0], &pixels));
}

}  // namespace
}  // namespace lf
