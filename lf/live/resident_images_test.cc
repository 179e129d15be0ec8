// SPDX-License-Identifier: Apache-2.0
#include "lf/live/resident_images.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "lf/render/collect/test_noise_field.h"

namespace lf {
namespace {

using testing::NoiseFrames;
using testing::NoiseStore;

constexpr size_t kImageBytes = size_t{testing::kWidth} * testing::kHeight * 8;

struct Loader {
  explicit Loader(size_t memory_bytes, uint32_t side = 7, double retry_s = 1e9)
      : field(testing::NoiseField(side)),
        index(field),
        images(
            index, store, memory_bytes, 2, [this] { ++change_count; }, retry_s) {}
  std::vector<uint32_t> Ids() {
    std::vector<uint32_t> ids;
    const auto snapshot = images.TakeSnapshot();
    for (const auto& one : snapshot->images) ids.push_back(one.id.value);
    return ids;
  }

  LightField field;
  ImageIndex index;
  NoiseStore store;
  std::atomic<int> change_count = 0;
  ResidentImages images;
};

bool HoldsNoise(const ResidentImages::Snapshot::Resident& one) {
  LfPixels pixels;
  EXPECT_TRUE(NoiseStore().Load(one.id, {0, 0, testing::kWidth, testing::kHeight}, &pixels));
  return one.image->pixels.radiance.pixels() == pixels.radiance.pixels();
}

// A frame of which an element is one LF pixel wide.
RenderCamera Frame(double x = 0, double radius_w = 0.03) {
  RenderCamera frame = NoiseFrames()[0];
  frame.pinhole.cam_from_world = *LookAlong({x, 0, 0}, {0, 0, 1}, {0, -1, 0});
  frame.focus_distance_w = 1;
  frame.focus_plane = FocusPlane(frame.pinhole, 1, {});
  frame.aperture = {radius_w, 0, 0};
  return frame;
}

TEST(ResidentImages, AllOfTheLensAreLoaded) {
  Loader loader(size_t{1} << 30);
  EXPECT_EQ(loader.images.TakeSnapshot()->field, nullptr);
  EXPECT_TRUE(loader.images.TakeSnapshot()->images.empty());
  loader.images.Aim(Frame());
  loader.images.WaitUntilLoaded();
  const ResidentImages::Status status = loader.images.status();
  EXPECT_EQ(status.divisor, 1);
  EXPECT_EQ(status.needed_count, status.wanted_count);
  EXPECT_EQ(status.wanted_count, status.wanted_done_count);
  EXPECT_EQ(status.resident_count, loader.Ids().size());
  EXPECT_GT(status.resident_count, 30U);
  EXPECT_GT(loader.change_count, 2);
  const auto snapshot = loader.images.TakeSnapshot();
  ASSERT_NE(snapshot->field, nullptr);
  EXPECT_TRUE(HoldsNoise(snapshot->images[0]));
}

TEST(ResidentImages, MemoryIsBoundedAndFollowsTheCamera) {
  Loader loader(5 * kImageBytes + 7);
  std::vector<uint32_t> before;
  for (const double x : {-0.03, 0.0, 0.03}) {
    loader.images.Aim(Frame(x, 0.008));
    loader.images.WaitUntilLoaded();
    const std::vector<uint32_t> ids = loader.Ids();
    EXPECT_EQ(ids.size(), 5U);
    EXPECT_NE(ids, before);
    before = ids;
    // All five are at the lens, or one LF camera beside it.
    for (const uint32_t id : ids)
      EXPECT_LT(std::abs(loader.field.Camera(LfImageId{id}).CentreWorld().x() - x), 0.02);
  }
  Loader tiny(1);
  tiny.images.Aim(Frame());
  tiny.images.WaitUntilLoaded();
  EXPECT_EQ(tiny.Ids().size(), 1U);
}

TEST(ResidentImages, AWiderLensLoadsMore) {
  Loader loader(size_t{1} << 30);
  loader.images.Aim(Frame(-0.03, 0.004));
  loader.images.WaitUntilLoaded();
  const size_t of_narrow_lens = loader.Ids().size();
  loader.images.Aim(Frame(-0.03, 0.04));
  loader.images.WaitUntilLoaded();
  EXPECT_GT(loader.Ids().size(), of_narrow_lens);
}

TEST(ResidentImages, AnotherSizeOfElementsBeginsAnew) {
  Loader loader(size_t{1} << 30);
  loader.images.Aim(Frame());
  loader.images.WaitUntilLoaded();
  RenderCamera coarse = Frame();
  coarse.pinhole.intrinsics = {20, 20, 10, 7.5, 0, 20, 15};
  loader.images.Aim(coarse);
  loader.images.WaitUntilLoaded();
  EXPECT_EQ(loader.images.status().divisor, 3);
  const auto snapshot = loader.images.TakeSnapshot();
  EXPECT_EQ(snapshot->field->intrinsics[0].width_px, testing::kWidth / 3);
  for (const auto& one : snapshot->images)
    EXPECT_EQ(one.image->pixels.rect.width(), testing::kWidth / 3);
}

TEST(ResidentImages, LoadingGoesOnWhileAPictureHoldsImages) {
  Loader loader(size_t{1} << 30);
  loader.images.Aim(Frame(-0.03, 0.008));
  loader.images.WaitUntilLoaded();
  const auto held = loader.images.TakeSnapshot();
  loader.images.Aim(Frame(0.03, 0.008));
  loader.images.WaitUntilLoaded();
  EXPECT_GT(loader.Ids().size(), held->images.size());
  RenderCamera coarse = Frame();
  coarse.pinhole.intrinsics = {20, 20, 10, 7.5, 0, 20, 15};
  loader.images.Aim(coarse);
  loader.images.WaitUntilLoaded();
  for (const auto& one : held->images) EXPECT_TRUE(HoldsNoise(one));
}

TEST(ResidentImages, ImagesThatAPictureHoldsCountAsMemory) {
  Loader loader(5 * kImageBytes);
  loader.images.Aim(Frame(-0.03, 0.008));
  loader.images.WaitUntilLoaded();
  auto held = loader.images.TakeSnapshot();
  const std::vector<uint32_t> first = loader.Ids();
  loader.images.Aim(Frame(0.03, 0.008));
  // Two threads load two LF images, for which two others are forgotten.
  while (loader.Ids() == first) std::this_thread::yield();
  EXPECT_EQ(loader.Ids().size(), 3U);
  for (const auto& one : held->images) EXPECT_TRUE(HoldsNoise(one));
  held = nullptr;
  loader.images.WaitUntilLoaded();
  EXPECT_EQ(loader.Ids().size(), 5U);
}

TEST(ResidentImages, BrokenImagesAreCountedAndPassedOver) {
  Loader loader(size_t{1} << 30);
  loader.store.broken = {24, 25};
  loader.store.without_memory = {31};
  loader.images.Aim(Frame());
  loader.images.WaitUntilLoaded();
  const ResidentImages::Status status = loader.images.status();
  EXPECT_EQ(status.broken_count, 3U);
  EXPECT_EQ(status.wanted_done_count, status.wanted_count);
  EXPECT_EQ(status.resident_count + 3, status.wanted_count);
  EXPECT_NE(status.first_broken.find("image"), std::string::npos);
}

TEST(ResidentImages, FailedImagesAreTriedAgainLater) {
  for (const double retry_s : {0.0, 1e9}) {
    Loader loader(size_t{1} << 30, 7, retry_s);
    loader.store.broken = {24, 25};
    loader.images.Aim(Frame());
    loader.images.WaitUntilLoaded();
    loader.store.broken = {25};
    loader.images.Aim(Frame());  // the same frame
    loader.images.WaitUntilLoaded();
    EXPECT_EQ(loader.images.status().broken_count, retry_s > 0 ? 2U : 1U);
    EXPECT_NE(loader.images.status().first_broken, "");
    loader.store.broken = {};
    loader.images.Aim(Frame(0.001));
    loader.images.WaitUntilLoaded();
    const ResidentImages::Status status = loader.images.status();
    EXPECT_EQ(status.broken_count, retry_s > 0 ? 2U : 0U);
    EXPECT_EQ(status.first_broken == "", retry_s == 0);
    EXPECT_EQ(status.wanted_done_count, status.wanted_count);
    EXPECT_EQ(status.resident_count + status.broken_count, status.wanted_count);
  }
}

TEST(ResidentImages, ManyLfCamerasStayWithinTheMemory) {
  Loader loader(20 * kImageBytes, 120);
  loader.images.Aim(Frame());
  loader.images.WaitUntilLoaded();
  EXPECT_EQ(loader.Ids().size(), 20U);
  const ResidentImages::Status status = loader.images.status();
  EXPECT_EQ(status.wanted_count, 20U);
  EXPECT_GT(status.needed_count, 1000U);
  EXPECT_LE(status.needed_count, loader.field.size());
  EXPECT_EQ(status.image_bytes, kImageBytes);
}

}  // namespace
}  // namespace lf
