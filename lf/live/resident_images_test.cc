#include "lf/live/resident_images.h"

#include <gtest/gtest.h>

#include <atomic>

#include "lf/render/collect/test_noise_field.h"

namespace lf {
namespace {

using testing::NoiseFrames;
using testing::NoiseStore;

constexpr size_t kImageBytes = size_t{testing::kWidth} * testing::kHeight * 8;

struct Loader {
  explicit Loader(size_t memory_bytes, uint32_t side = 7)
      : field(testing::NoiseField(side)),
        index(field),
        images(index, store, memory_bytes, 2, [this] { ++change_count; }) {}
  std::vector<uint32_t> Ids() {
    std::vector<uint32_t> ids;
    images.Use([&](const LightField*, const std::map<uint32_t, ResidentImages::Image>& all) {
      for (const auto& [id, image] : all) ids.push_back(id);
    });
    return ids;
  }

  LightField field;
  ImageIndex index;
  NoiseStore store;
  std::atomic<int> change_count = 0;
  ResidentImages images;
};

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
  loader.images.Use([](const LightField* field, const auto& images) {
    EXPECT_EQ(field, nullptr);
    EXPECT_TRUE(images.empty());
  });
  loader.images.Aim(Frame());
  loader.images.WaitUntilLoaded();
  const ResidentImages::Status status = loader.images.status();
  EXPECT_EQ(status.divisor, 1);
  EXPECT_EQ(status.wanted_count, status.wanted_done_count);
  EXPECT_EQ(status.resident_count, loader.Ids().size());
  EXPECT_GT(status.resident_count, 30U);
  EXPECT_GT(loader.change_count, 2);
  loader.images.Use([](const LightField* field, std::map<uint32_t, ResidentImages::Image>& images) {
    ASSERT_NE(field, nullptr);
    LfPixels pixels;
    ASSERT_TRUE(NoiseStore().Load(LfImageId{images.begin()->first},
                                  {0, 0, testing::kWidth, testing::kHeight}, &pixels));
    EXPECT_EQ(images.begin()->second.pixels.radiance.pixels(), pixels.radiance.pixels());
  });
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

TEST(ResidentImages, AnotherSizeOfElementsBeginsAnew) {
  Loader loader(size_t{1} << 30);
  loader.images.Aim(Frame());
  loader.images.WaitUntilLoaded();
  RenderCamera coarse = Frame();
  coarse.pinhole.intrinsics = {20, 20, 10, 7.5, 0, 20, 15};
  loader.images.Aim(coarse);
  loader.images.WaitUntilLoaded();
  EXPECT_EQ(loader.images.status().divisor, 3);
  loader.images.Use([](const LightField* field, std::map<uint32_t, ResidentImages::Image>& images) {
    EXPECT_EQ(field->intrinsics[0].width_px, testing::kWidth / 3);
    for (const auto& [id, image] : images)
      EXPECT_EQ(image.pixels.rect.width(), testing::kWidth / 3);
  });
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

TEST(ResidentImages, ManyLfCamerasStayWithinTheMemory) {
  Loader loader(20 * kImageBytes, 120);
  loader.images.Aim(Frame());
  loader.images.WaitUntilLoaded();
  EXPECT_EQ(loader.Ids().size(), 20U);
  EXPECT_EQ(loader.images.status().wanted_count, 20U);
}

}  // namespace
}  // namespace lf
