// SPDX-License-Identifier: Apache-2.0
#include "lf/live/live_renderer.h"

#include <gtest/gtest.h>

#include "lf/live/shrink.h"
#include "lf/render/collect/collect.h"
#include "lf/render/collect/frame_lens.h"
#include "lf/render/collect/test_noise_field.h"
#include "lf/storage/load/demosaic.h"

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

// Serves LF images of another store, shrunken.
class ShrunkStore : public LfImageStore {
 public:
  ShrunkStore(const LfImageStore& full, int divisor, std::vector<LfImageId> ids)
      : full_(full), divisor_(divisor), ids_(std::move(ids)) {}
  Result<void> Load(LfImageId id, const PixelRect& /*rect*/, LfPixels* pixels) const override {
    LfPixels full;
    LF_RETURN_IF_ERROR(
        full_.Load(ids_[id.value], {0, 0, testing::kWidth, testing::kHeight}, &full));
    Shrink(full, divisor_, pixels);
    return {};
  }

 private:
  const LfImageStore& full_;
  const int divisor_;
  const std::vector<LfImageId> ids_;
};

// LF images of noise, about a third of which is masked in blocks of 5 x 5 pixels.
class MaskedStore : public NoiseStore {
 public:
  Result<void> Load(LfImageId id, const PixelRect& rect, LfPixels* pixels) const override {
    LF_RETURN_IF_ERROR(NoiseStore::Load(id, rect, pixels));
    for (int y = rect.y_begin; y < rect.y_end; ++y)
      for (int x = rect.x_begin; x < rect.x_end; ++x)
        if (RandomUnit(17, id.value, static_cast<uint64_t>(y / 5 * 100 + x / 5)) < 0.3)
          pixels->Mask(x - rect.x_begin, y - rect.y_begin);
    return {};
  }
};

// A mosaic of noise, converted to RGB.
class MosaicStore : public NoiseStore {
 public:
  Result<void> Load(LfImageId id, const PixelRect& rect, LfPixels* pixels) const override {
    const PixelRect whole = {0, 0, testing::kWidth, testing::kHeight};
    LfPixels noise, mosaic(whole, BayerPattern::kGbrg);
    LF_RETURN_IF_ERROR(NoiseStore::Load(id, whole, &noise));
    for (int y = 0; y < testing::kHeight; ++y)
      for (int x = 0; x < testing::kWidth; ++x)
        mosaic.radiance.at(x, y) = noise.radiance.at(x, y, BayerChannel(mosaic.bayer, x, y));
    RadianceEncoding encoding;
    encoding.white_balance = {2, 1, 1.5};
    Demosaic(mosaic, testing::kWidth, testing::kHeight, encoding, rect, pixels);
    return {};
  }
};

// Collects the frame as FilmRenderer does (FrameLens, SelectImages(), Collect()), of exactly these
// LF images in batches of three.
SensorPlate CollectedOf(const LightField& field, const LfImageStore& store, int divisor,
                        const std::vector<LfImageId>& ids, const RenderCamera& frame,
                        ThreadPool& pool) {
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
      Collect(some, ShrunkStore(store, divisor, ids), {collected}, images, options, pool, nullptr));
  return plate;
}

int ElementsWithRays(const SensorPlate& plate) {
  int count = 0;
  for (int y = 0; y < plate.height(); ++y)
    for (int x = 0; x < plate.width(); ++x) count += plate.At(x, y, 0).count > 0 ? 1 : 0;
  return count;
}

// Compares live pictures, quick and still ones, of the three frames with collected ones. Frame 1
// has a pentagon as aperture, and frames 1 and 2 a tilted focus plane.
void ExpectBitsOfCollected(const LightField& field, const LfImageStore& store, int threads,
                           double element_px) {
  const ImageIndex index(field);
  ThreadPool pool(threads);
  LiveRenderer live(index, store, {}, pool);
  for (int i = 0; i < 3; ++i) {
    SCOPED_TRACE(::testing::Message() << threads << " threads, " << element_px << ", frame " << i);
    const RenderCamera frame = Frame(i, element_px);
    ASSERT_TRUE(live.Render(frame, {}));
    live.images().WaitUntilLoaded();
    for (const std::optional<double>& budget_s : {std::optional<double>(), {1e-9}}) {
      const Result<LivePicture> picture = live.Render(frame, {budget_s, false, nullptr});
      ASSERT_TRUE(picture);
      EXPECT_GE(picture->images.size(), LiveRenderer::kFewestImages);
      const int divisor = live.images().status().divisor;
      EXPECT_TRUE(picture->plate ==
                  CollectedOf(field, store, divisor, picture->images, frame, pool));
      EXPECT_GT(ElementsWithRays(picture->plate), picture->plate.width());
    }
  }
}

TEST(LiveRenderer, PicturesHaveTheBitsOfACollectedFrame) {
  LightField field = testing::NoiseField();
  Intrinsics bent = field.intrinsics[0];
  bent.distortion = {DistortionModel::kRadialTangential, {-0.1, 0.02, 0.001}};
  field.intrinsics.push_back(bent);
  for (uint32_t i = 0; i < field.size(); i += 3) field.cameras[i].intrinsics_index = 1;
  for (const int threads : {1, 2, 3})
    for (const double element_px : {1.0, 1.9, 3.3})
      ExpectBitsOfCollected(field, NoiseStore(), threads, element_px);
}

TEST(LiveRenderer, MasksMosaicsAndCamerasInTheLensPlaneHaveTheBitsOfACollectedFrame) {
  LightField field = testing::NoiseField();
  for (const double element_px : {1.0, 3.3})
    ExpectBitsOfCollected(field, MaskedStore(), 2, element_px);
  // All LF cameras stand in the lens plane of frame 0, one of them in the middle of its lens.
  LightField flat = field;
  for (uint32_t i = 0; i < flat.size(); ++i) {
    Vec3 centre = field.Camera(LfImageId{i}).CentreWorld();
    centre.z() = 0;
    flat.cameras[i].cam_from_world = *LookAlong(centre, {0, 0.02, 1}, {0, -1, 0});
  }
  flat.cameras[24].cam_from_world = *LookAlong({0, 0, 0}, {0, 0, 1}, {0, -1, 0});
  ExpectBitsOfCollected(flat, NoiseStore(), 2, 1.9);
  field.encoding.bayer = BayerPattern::kGbrg;
  field.encoding.white_balance = {2, 1, 1.5};
  for (const double element_px : {1.0, 1.9})
    ExpectBitsOfCollected(field, MosaicStore(), 2, element_px);
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
  const Result<LivePicture> quick = live.Render(frame, {1e-9, false, nullptr});
  const Result<LivePicture> slow = live.Render(frame, {100.0, false, nullptr});
  const Result<LivePicture> still = live.Render(frame, {});
  ASSERT_TRUE(quick && slow && still);
  EXPECT_EQ(quick->images.size(), LiveRenderer::kFewestImages);
  EXPECT_EQ(slow->images, still->images);
  EXPECT_EQ(still->images.size(), still->takeable_count);
  EXPECT_GT(still->takeable_count, 100U);
  EXPECT_GT(quick->camera_distance_w, 1.5 * still->camera_distance_w);
  EXPECT_LE(still->uncovered_share, quick->uncovered_share);
}

// LF images of lenses before stay in memory, and those beside a lens are loaded with it.
TEST(LiveRenderer, PicturesCountTheImagesThatTheFrameUses) {
  const LightField field = testing::NoiseField(16);
  const ImageIndex index(field);
  const NoiseStore store;
  ThreadPool pool(2);
  for (const LensWeights weights : {LensWeights::kAuto, LensWeights::kNone}) {
    LiveOptions options;
    options.lens_weights = weights;
    LiveRenderer live(index, store, options, pool);
    size_t most = 0;
    for (const double factor : {1.0, 0.4}) {
      RenderCamera frame = Frame(0, 1);
      frame.aperture.radius_w *= factor;
      ASSERT_TRUE(live.Render(frame, {}));
      live.images().WaitUntilLoaded();
      const Result<LivePicture> picture = live.Render(frame, {});
      ASSERT_TRUE(picture);
      SelectOptions select;
      select.reach = PixelReach::kNeighbours;
      const FrameLens lens(index, frame, weights, select, pool);
      const size_t used_count = UsedCount(lens, index, select, pool);
      EXPECT_EQ(picture->used_count, used_count);
      EXPECT_EQ(live.PlanLens(frame, SIZE_MAX, false).lens.used_count, used_count);
      EXPECT_LT(used_count, picture->images.size());
      EXPECT_GT(used_count, 4U);
      most = std::max(most, used_count);
      if (factor < 1) {
        EXPECT_LT(used_count, most);
      }
    }
  }
}

TEST(LiveRenderer, VirtualImagesCanBeLeftOut) {
  LightField field = testing::NoiseField();
  for (uint32_t i = 0; i < field.size(); i += 2) field.cameras[i].is_virtual = true;
  const ImageIndex index(field);
  const NoiseStore store;
  ThreadPool pool(2);
  LiveRenderer live(index, store, {}, pool);
  const RenderCamera frame = Frame(0, 1.9);
  ASSERT_TRUE(live.Render(frame, {}));
  live.images().WaitUntilLoaded();
  const Result<LivePicture> all = live.Render(frame, {});
  const Result<LivePicture> recorded = live.Render(frame, {{}, true, nullptr});
  ASSERT_TRUE(all && recorded);
  EXPECT_GT(recorded->images.size(), all->images.size() / 3);
  EXPECT_LT(recorded->images.size(), all->images.size());
  EXPECT_EQ(recorded->takeable_count, recorded->images.size());
  for (const LfImageId id : recorded->images) EXPECT_FALSE(field.cameras[id.value].is_virtual);
  EXPECT_TRUE(recorded->plate == CollectedOf(field, store, live.images().status().divisor,
                                             recorded->images, frame, pool));
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
  const Result<LivePicture> none = live.Render(frame, {{}, false, &interrupted});
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().kind, ErrorKind::kInterrupted);
  EXPECT_TRUE(live.Render(frame, {})->plate == before->plate);
}

}  // namespace
}  // namespace lf
