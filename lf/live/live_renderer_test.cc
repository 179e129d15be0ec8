#include "lf/live/live_renderer.h"

#include <gtest/gtest.h>

#include "lf/live/shrink.h"
#include "lf/render/collect/collect.h"
#include "lf/render/collect/frame_lens.h"
#include "lf/render/collect/test_noise_field.h"

namespace lf {
namespace {

using testing::NoiseFrames;
using testing::NoiseStore;

// The frames of test_noise_field.h, with elements of about `element_px` LF pixels.
RenderCamera Frame(int i, double element_px) {
  RenderCamera frame = NoiseFrames()[static_cast<size_t>(i)];
  frame.focus_distance_w = 1 + i;
  return WithPlateWidth(frame, static_cast<int>(70 / element_px), 1000);
}

// Serves shrunken LF images of noise.
class ShrunkStore : public LfImageStore {
 public:
  ShrunkStore(int divisor, std::vector<LfImageId> ids) : divisor_(divisor), ids_(std::move(ids)) {}
  Result<void> Load(LfImageId id, const PixelRect& /*rect*/, LfPixels* pixels) const override {
    LfPixels full;
    LF_RETURN_IF_ERROR(
        NoiseStore().Load(ids_[id.value], {0, 0, testing::kWidth, testing::kHeight}, &full));
    Shrink(full, divisor_, pixels);
    return {};
  }

 private:
  const int divisor_;
  const std::vector<LfImageId> ids_;
};

// Collects the frame as FilmRenderer does (FrameLens, SelectImages(), Collect()), of exactly these
// LF images in batches of three.
SensorPlate CollectedOf(const LightField& field, int divisor, const std::vector<LfImageId>& ids,
                        const RenderCamera& frame, ThreadPool& pool) {
  const LightField shrunk = ShrunkField(field, divisor);
  LightField some = shrunk;
  some.cameras.clear();
  for (const LfImageId id : ids) some.cameras.push_back(shrunk.cameras[id.value]);
  some.image_names.resize(ids.size());
  const ImageIndex index(some, 5);
  SelectOptions select;
  select.reach = PixelReach::kNeighbours;
  const FrameLens lens(index, frame, LensWeights::kAuto, select, pool);
  SensorPlate plate(frame.pinhole.intrinsics.width_px, frame.pinhole.intrinsics.height_px);
  CollectedFrame collected = {lens.camera(), &plate};
  collected.weights = [&](LfImageId id) { return lens.WeightsOf(id); };
  CollectOptions options;
  options.reading = RayReading(Estimator::kBilinear);
  options.reading.filter = PixelFilter::kBilinear;
  options.batch_image_count = 3;
  const TakingFrame taking = {lens.camera(), {}, [&](LfImageId id) { return lens.Takes(id); }};
  const std::vector<SelectedImage> images =
      SelectImages(index, std::span(&taking, 1), select, pool);
  EXPECT_TRUE(
      Collect(some, ShrunkStore(divisor, ids), {collected}, images, options, pool, nullptr));
  return plate;
}

TEST(LiveRenderer, PicturesHaveTheBitsOfACollectedFrame) {
  LightField field = testing::NoiseField();
  Intrinsics bent = field.intrinsics[0];
  bent.distortion = {DistortionModel::kRadialTangential, {-0.1, 0.02, 0.001}};
  field.intrinsics.push_back(bent);
  for (uint32_t i = 0; i < field.size(); i += 3) field.cameras[i].intrinsics_index = 1;
  const ImageIndex index(field);
  const NoiseStore store;
  for (const int threads : {1, 2, 3}) {
    ThreadPool pool(threads);
    LiveRenderer live(index, store, {}, pool);
    for (const double element_px : {1.0, 1.9, 3.3})
      for (int i = 0; i < 3; ++i) {
        const RenderCamera frame = Frame(i, element_px);
        ASSERT_TRUE(live.Render(frame, {}));
        live.images().WaitUntilLoaded();
        for (const std::optional<double>& budget_s : {std::optional<double>(), {1e-9}}) {
          const Result<LivePicture> picture = live.Render(frame, {budget_s, nullptr});
          ASSERT_TRUE(picture);
          EXPECT_GE(picture->images.size(), LiveRenderer::kFewestImages);
          const int divisor = live.images().status().divisor;
          EXPECT_TRUE(picture->plate == CollectedOf(field, divisor, picture->images, frame, pool))
              << threads << " " << element_px << " " << i;
          EXPECT_GT(picture->plate.At(frame.pinhole.intrinsics.width_px / 2, 3, 0).count, 0U);
        }
      }
  }
}

TEST(LiveRenderer, ShortTimeTakesFewImagesAndMoreTimeAll) {
  const LightField field = testing::NoiseField(16);
  const ImageIndex index(field);
  const NoiseStore store;
  ThreadPool pool(2);
  LiveRenderer live(index, store, {}, pool);
  const RenderCamera frame = Frame(0, 1);
  ASSERT_TRUE(live.Render(frame, {}));
  live.images().WaitUntilLoaded();
  const Result<LivePicture> quick = live.Render(frame, {1e-9, nullptr});
  const Result<LivePicture> slow = live.Render(frame, {100.0, nullptr});
  const Result<LivePicture> still = live.Render(frame, {});
  ASSERT_TRUE(quick && slow && still);
  EXPECT_EQ(quick->images.size(), LiveRenderer::kFewestImages);
  EXPECT_EQ(slow->images, still->images);
  EXPECT_EQ(still->images.size(), still->takeable_count);
  EXPECT_GT(still->takeable_count, 100U);
  EXPECT_GT(quick->camera_distance_w, 1.5 * still->camera_distance_w);
  EXPECT_LE(still->uncovered_share, quick->uncovered_share);
}

TEST(LiveRenderer, WithoutImagesThePictureIsBlack) {
  const LightField field = testing::NoiseField();
  const ImageIndex index(field);
  NoiseStore store;
  for (uint32_t i = 0; i < field.size(); ++i) store.broken.push_back(i);
  ThreadPool pool(1);
  LiveRenderer live(index, store, {}, pool);
  for (int i = 0; i < 2; ++i) {
    const Result<LivePicture> picture = live.Render(Frame(0, 1), {});
    ASSERT_TRUE(picture);
    EXPECT_TRUE(picture->images.empty());
    EXPECT_EQ(picture->picture.rgb.at(3, 4, 1), 0);
    EXPECT_EQ(picture->uncovered_share, 1);
    live.images().WaitUntilLoaded();
  }
}

TEST(LiveRenderer, InterruptedPicturesAreErrorsAndLoseNothing) {
  const LightField field = testing::NoiseField();
  const ImageIndex index(field);
  const NoiseStore store;
  ThreadPool pool(2);
  LiveRenderer live(index, store, {}, pool);
  const RenderCamera frame = Frame(1, 1);
  ASSERT_TRUE(live.Render(frame, {}));
  live.images().WaitUntilLoaded();
  const Result<LivePicture> before = live.Render(frame, {});
  const std::atomic<bool> interrupted = true;
  const Result<LivePicture> none = live.Render(frame, {{}, &interrupted});
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().kind, ErrorKind::kInterrupted);
  EXPECT_TRUE(live.Render(frame, {})->plate == before->plate);
}

}  // namespace
}  // namespace lf
