// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/working_images.h"

#include <gtest/gtest.h>

#include <vector>

#include "lf/densify/test_world.h"

namespace lf {
namespace {

constexpr int kSide = 8;
// The size of one working image: light, tones and compared tones, each [kSide][kSide][4] numbers
// of 16 bits.
constexpr size_t kImageBytes = size_t{kSide} * kSide * 4 * 2 * 3;

LightField FourCameras() {
  LightField field;
  field.intrinsics = {CameraAt(0, 0, kSide, kSide).intrinsics};
  for (int i = 0; i < 4; ++i) {
    LfCamera camera;
    camera.cam_from_world = CameraAt(0.1 * i, 0).cam_from_world;
    field.cameras.push_back(camera);
    field.image_names.push_back(std::to_string(i));
  }
  return field;
}

// Loads black LF images, and remembers their ids in the order of loading. For one thread.
class ListingStore : public LfImageStore {
 public:
  Result<void> Load(LfImageId id, const PixelRect& rect, LfPixels* pixels) const override {
    loaded.push_back(id.value);
    *pixels = LfPixels(rect, BayerPattern::kNone);
    return {};
  }
  mutable std::vector<uint32_t> loaded;
};

TEST(WorkingImages, TheImagesThatWereUsedLongestAgoAreDroppedBeyondTheLimit) {
  const LightField field = FourCameras();
  ListingStore store;
  WorkingImages images(field, store, 1, 2 * kImageBytes);
  for (const uint32_t id : {0U, 1U, 0U, 2U, 0U, 1U}) ASSERT_TRUE(images.Get(LfImageId{id}));
  // 2 dropped 1, because 0 was used later, and the second 1 is loaded again.
  EXPECT_EQ(store.loaded, (std::vector<uint32_t>{0, 1, 2, 1}));
}

TEST(WorkingImages, AnImageInUseOutlivesItsPlaceInTheCache) {
  const LightField field = FourCameras();
  ListingStore store;
  WorkingImages images(field, store, 1, 1);
  const auto held = images.Get(LfImageId{0});
  ASSERT_TRUE(held);
  ASSERT_TRUE(images.Get(LfImageId{3}));
  EXPECT_EQ((*held)->width(), kSide);
  EXPECT_EQ(held->use_count(), 1) << "the cache still holds the image";
  ASSERT_TRUE(images.Get(LfImageId{0}));
  EXPECT_EQ(store.loaded, (std::vector<uint32_t>{0, 3, 0}));
}

}  // namespace
}  // namespace lf
