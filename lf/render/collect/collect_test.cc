// SPDX-License-Identifier: Apache-2.0
#include "lf/render/collect/collect.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "lf/render/collect/test_noise_field.h"

namespace lf {
namespace {

using testing::NoiseFrames;
using testing::NoiseStore;

struct Outcome {
  std::vector<SensorPlate> plates;
  Result<CollectStatistics> statistics;
};

Outcome CollectAll(const NoiseStore& store, int threads, CollectOptions options, uint64_t seed = 0,
                   std::vector<uint32_t> left_out = {}) {
  static const LightField field = testing::NoiseField();
  static const std::vector<RenderCamera> frames = NoiseFrames();
  ThreadPool pool(threads);
  std::vector<SelectedImage> images = SelectImages(ImageIndex(field, seed), frames, {}, pool);
  std::erase_if(images, [&](const SelectedImage& image) {
    return std::count(left_out.begin(), left_out.end(), image.id.value) > 0;
  });
  std::vector<SensorPlate> plates;
  for (size_t i = 0; i < frames.size(); ++i) plates.emplace_back(80, 60);
  auto statistics = Collect(field, store, FramesOf(frames, plates), images, options, pool, nullptr);
  return {std::move(plates), std::move(statistics)};
}

// Half of the LF cameras have no distortion. The other half have one of five distorted lenses, most
// of them the first one.
LightField DistortedField() {
  LightField field = testing::NoiseField();
  for (uint32_t i = 0; i < 5; ++i) {
    Intrinsics k = field.intrinsics[0];
    k.distortion = {DistortionModel::kRadialTangential, {-0.1 - 0.01 * i, 0.02, 0.001}};
    field.intrinsics.push_back(k);
  }
  for (uint32_t i = 0; i < field.size(); ++i)
    field.cameras[i].intrinsics_index = i % 2 == 0 ? 0 : i % 3 == 0 ? 1 + i % 5 : 1;
  return field;
}

std::vector<SensorPlate> CollectDistorted(int threads, const CollectOptions& options,
                                          uint64_t* accepted) {
  const LightField field = DistortedField();
  const std::vector<RenderCamera> frames = NoiseFrames();
  ThreadPool pool(threads);
  const std::vector<SelectedImage> images =
      SelectImages(ImageIndex(field), frames, {.reach = ReachOf(options.reading)}, pool);
  std::vector<SensorPlate> plates;
  for (size_t i = 0; i < frames.size(); ++i) plates.emplace_back(80, 60);
  const auto statistics =
      Collect(field, NoiseStore(), FramesOf(frames, plates), images, options, pool, nullptr);
  EXPECT_TRUE(statistics);
  *accepted = 0;
  if (statistics)
    for (const FrameRays& rays : statistics->frames) *accepted += rays.accepted_count;
  return plates;
}

TEST(Collect, FramesThatPassByTakeWhatTheyTakeAlone) {
  const LightField field = testing::NoiseField(14);
  std::vector<RenderCamera> frames;
  for (int i = 0; i < 20; ++i) {
    frames.push_back(NoiseFrames()[i % 3]);
    // The frames move across the grid of LF cameras. The first and the last ones are beside the
    // grid.
    frames.back().pinhole.cam_from_world =
        *LookAlong({0.012 * (i - 10), 0, 0}, {0, 0, 1}, {0, -1, 0});
    frames.back().aperture.radius_w = 0.006;
    frames.back().focus_plane = FocusPlane(frames.back().pinhole, 1 + i % 3, {0, 0});
  }
  ThreadPool pool(2);
  CollectOptions options;
  options.batch_image_count = 3;
  options.plan_bytes = 1;
  const auto collect = [&](std::span<const RenderCamera> some, std::vector<SensorPlate>* plates) {
    for (size_t f = 0; f < some.size(); ++f) plates->emplace_back(80, 60);
    const std::vector<SelectedImage> images = SelectImages(ImageIndex(field), some, {}, pool);
    return Collect(field, NoiseStore(), FramesOf(some, *plates), images, options, pool, nullptr)
        ->frames;
  };
  std::vector<SensorPlate> plates;
  const std::vector<FrameRays> rays = collect(frames, &plates);
  size_t idle_frames = 0;
  for (size_t f = 0; f < frames.size(); ++f) {
    std::vector<SensorPlate> alone;
    const FrameRays rays_alone = collect(std::span(frames).subspan(f, 1), &alone)[0];
    EXPECT_EQ(plates[f], alone[0]) << f;
    EXPECT_EQ(rays[f].tested_count, rays_alone.tested_count) << f;
    EXPECT_EQ(rays[f].accepted_count, rays_alone.accepted_count) << f;
    idle_frames += rays[f].accepted_count == 0;
  }
  EXPECT_GT(idle_frames, 5u);
  EXPECT_LT(idle_frames, 15u);
}

TEST(Collect, BothEstimatorsThroughLensesThatBendRays) {
  for (const Estimator estimator : {Estimator::kNearest, Estimator::kBilinear}) {
    CollectOptions options;
    options.reading.estimator = estimator;
    uint64_t accepted = 0, accepted_again = 0, accepted_by_reference = 0;
    const std::vector<SensorPlate> expected = CollectDistorted(1, options, &accepted);
    EXPECT_GT(accepted, 100000u);
    options.batch_image_count = 3;
    EXPECT_EQ(CollectDistorted(2, options, &accepted_again), expected);
    EXPECT_EQ(accepted_again, accepted);
    options.back_end = CollectBackEnd::kReference;
    CollectDistorted(1, options, &accepted_by_reference);
    EXPECT_NEAR(static_cast<double>(accepted_by_reference), static_cast<double>(accepted),
                1e-4 * static_cast<double>(accepted));
  }
}

TEST(Collect, TheSameBitsForAnyThreadsBatchesAndOrder) {
  const NoiseStore store;
  CollectOptions options;
  const Outcome expected = CollectAll(store, 1, options);
  ASSERT_TRUE(expected.statistics);
  EXPECT_GT(expected.statistics->frames[0].accepted_count, 50000u);
  for (const int threads : {1, 2, 3})
    for (const int batch : {1, 5, 64})
      for (const uint64_t seed : {0, 7}) {
        options.batch_image_count = batch;
        const Outcome other = CollectAll(store, threads, options, seed);
        EXPECT_EQ(other.plates, expected.plates) << threads << ", " << batch << ", " << seed;
      }
}

// Elements of 1 to 6 LF pixels need different prefilters of the same LF images. A rectangle that is
// too small for a prefilter, or a filtered image that is used for the wrong frame, changes bits.
TEST(Collect, PrefiltersServeFramesOfAnyScale) {
  const LightField field = DistortedField();
  std::vector<RenderCamera> frames;
  for (int i = 0; i < 9; ++i) {
    frames.push_back(NoiseFrames()[static_cast<size_t>(i) % 3]);
    Intrinsics& k = frames.back().pinhole.intrinsics;
    k.fx_px /= 1 + 0.35 * i;
    k.fy_px /= 1 + 0.35 * i;
  }
  CollectOptions options;
  options.reading.estimator = Estimator::kBilinear;
  options.reading.filter = PixelFilter::kPrefiltered;
  const auto collect = [&](int threads) {
    ThreadPool pool(threads);
    const SelectOptions select{.reach = ReachOf(options.reading),
                               .whole_images = options.whole_images};
    const std::vector<SelectedImage> images = SelectImages(ImageIndex(field), frames, select, pool);
    std::vector<SensorPlate> plates;
    for (size_t f = 0; f < frames.size(); ++f) plates.emplace_back(80, 60);
    const auto statistics =
        Collect(field, NoiseStore(), FramesOf(frames, plates), images, options, pool, nullptr);
    EXPECT_TRUE(statistics);
    EXPECT_GT(statistics->frames.back().accepted_count, 5000u);
    return plates;
  };
  const std::vector<SensorPlate> expected = collect(1);
  options.batch_image_count = 3;
  options.plan_bytes = 1;
  EXPECT_EQ(collect(2), expected);
  options.whole_images = true;
  EXPECT_EQ(collect(3), expected);
  options.back_end = CollectBackEnd::kReference;
  const std::vector<SensorPlate> reference = collect(1);
  for (size_t f = 0; f < frames.size(); ++f)
    for (int y = 0; y < 60; ++y)
      for (int x = 0; x < 80; ++x)
        EXPECT_NEAR(static_cast<double>(reference[f].At(x, y, 1).count),
                    static_cast<double>(expected[f].At(x, y, 1).count), 1)
            << f;
}

// Loads every LF image with its red channel as opacity.
class RedOpacityStore : public LfImageStore {
 public:
  Result<void> Load(LfImageId id, const PixelRect& rect, LfPixels* pixels) const override {
    LF_RETURN_IF_ERROR(NoiseStore().Load(id, rect, pixels));
    if (id.value % 3 == 0) pixels->Mask(0, 0);
    pixels->opacity = pixels->radiance;
    for (int y = 0; y < rect.height(); ++y)
      for (int x = 0; x < rect.width(); ++x)
        for (int c = 1; c < 3; ++c) pixels->opacity.at(x, y, c) = pixels->opacity.at(x, y, 0);
    return {};
  }
};

TEST(Collect, OpacityIsCollectedByTheRaysAndWeightsOfColours) {
  const LightField field = testing::NoiseField();
  const std::vector<RenderCamera> frames = NoiseFrames();
  for (const Estimator estimator : {Estimator::kNearest, Estimator::kBilinear})
    for (const CollectBackEnd back_end : {CollectBackEnd::kFast, CollectBackEnd::kReference})
      for (const bool has_weights : {false, true}) {
        CollectOptions options;
        options.reading.estimator = estimator;
        options.back_end = back_end;
        options.batch_image_count = 5;
        ThreadPool pool(2);
        const std::vector<SelectedImage> images =
            SelectImages(ImageIndex(field), frames, {.reach = ReachOf(estimator)}, pool);
        std::vector<SensorPlate> plates, colours;
        for (size_t f = 0; f < frames.size(); ++f) {
          plates.push_back(SensorPlate(80, 60, PlateKind::kOpacity));
          colours.emplace_back(80, 60);
        }
        for (std::vector<SensorPlate>* into : {&plates, &colours}) {
          std::vector<CollectedFrame> collected = FramesOf(frames, *into);
          if (has_weights)
            for (CollectedFrame& frame : collected)
              frame.weights = [](LfImageId id) { return RayWeights(1 + id.value % 7); };
          ASSERT_TRUE(Collect(field, RedOpacityStore(), collected, images, options, pool, {}));
        }
        for (size_t f = 0; f < frames.size(); ++f)
          for (int y = 0; y < 60; ++y)
            for (int x = 0; x < 80; ++x) {
              ASSERT_EQ(plates[f].At(x, y, SensorPlate::kOpacityChannel), plates[f].At(x, y, 0));
              for (int c = 0; c < 3; ++c) ASSERT_EQ(plates[f].At(x, y, c), colours[f].At(x, y, c));
            }
      }
}

// Returns three instants of one frame, whose rays have different weights if has_weights is true.
std::vector<CollectedInstant> Instants(bool has_weights) {
  std::vector<CollectedInstant> instants;
  for (uint32_t k = 0; k < 3; ++k) {
    RenderCamera camera = NoiseFrames()[0];
    camera.pinhole.cam_from_world.translation.x() += 0.004 * k;
    camera.aperture.radius_w *= 1 + 0.1 * k;
    // The zoom is so fast that the instants need different prefilters.
    camera.pinhole.intrinsics.fx_px = camera.pinhole.intrinsics.fy_px = 80 - 24 * k;
    ImageWeights weights;
    if (has_weights)
      weights = [k](LfImageId id) { return RayWeights((id.value + k) % 4 * (k + 1)); };
    instants.push_back({camera, weights});
  }
  return instants;
}

TEST(Collect, AFrameWithAShutterIsTheSumOfItsInstants) {
  const LightField field = testing::NoiseField();
  for (const Estimator estimator : {Estimator::kNearest, Estimator::kBilinear})
    for (const CollectBackEnd back_end : {CollectBackEnd::kFast, CollectBackEnd::kReference})
      for (const bool has_weights : {false, true}) {
        SCOPED_TRACE(std::string(NameOf(estimator)) + (has_weights ? " weighted" : ""));
        CollectOptions options;
        options.reading.estimator = estimator;
        options.back_end = back_end;
        ThreadPool pool(3);
        const std::vector<CollectedInstant> instants = Instants(has_weights);
        std::vector<RenderCamera> cameras;
        for (const CollectedInstant& instant : instants) cameras.push_back(instant.camera);
        const std::vector<SelectedImage> images =
            SelectImages(ImageIndex(field), cameras, {.reach = ReachOf(estimator)}, pool);

        SensorPlate together(80, 60, PlateKind::kOpacity), sum(80, 60, PlateKind::kOpacity);
        NoiseMoments moments(80, 60);
        CollectedFrame frame{instants[0].camera, &together, {}, instants[0].weights};
        frame.further.assign(instants.begin() + 1, instants.end());
        frame.moments = &moments;
        options.batch_image_count = 5;
        const auto all = Collect(field, RedOpacityStore(), {frame}, images, options, pool, {});
        ASSERT_TRUE(all);

        options.batch_image_count = 16;
        FrameRays rays;
        for (const CollectedInstant& instant : instants) {
          SensorPlate plate(80, 60, PlateKind::kOpacity);
          const auto one = Collect(field, RedOpacityStore(),
                                   {CollectedFrame{instant.camera, &plate, {}, instant.weights}},
                                   images, options, pool, {});
          ASSERT_TRUE(one);
          rays += one->frames[0];
          sum.Merge(plate);
        }
        EXPECT_EQ(together, sum);
        EXPECT_EQ(all->frames[0].tested_count, rays.tested_count);
        EXPECT_EQ(all->frames[0].accepted_count, rays.accepted_count);
        // An LF image counts once, although it has rays at several instants.
        EXPECT_LT(all->frames[0].image_count, rays.image_count);
        EXPECT_LE(all->frames[0].image_count, field.size());
        for (size_t i = 0; i < moments.size(); ++i)
          EXPECT_LE(moments.At(i, 0).image_count, all->frames[0].image_count);
        // The moments are those of the totals of LF images, whichever the batches.
        EXPECT_TRUE(NoiseMoments::Read(moments.Text(), together));
      }
}

TEST(Collect, AnImageIsOneMeasurementAtAllInstantsTogether) {
  const LightField field = testing::NoiseField();
  ThreadPool pool(2);
  const std::vector<CollectedInstant> instants = Instants(true);
  std::vector<RenderCamera> cameras;
  for (const CollectedInstant& instant : instants) cameras.push_back(instant.camera);
  CollectOptions options;
  options.reading.estimator = Estimator::kBilinear;
  const std::vector<SelectedImage> images =
      SelectImages(ImageIndex(field), cameras, {.reach = ReachOf(options.reading)}, pool);
  for (const CollectBackEnd back_end : {CollectBackEnd::kFast, CollectBackEnd::kReference}) {
    options.back_end = back_end;
    const auto collect = [&](std::span<const SelectedImage> order, SensorPlate* plate,
                             NoiseMoments* moments) {
      CollectedFrame frame{instants[0].camera, plate, {}, instants[0].weights};
      frame.further.assign(instants.begin() + 1, instants.end());
      frame.moments = moments;
      EXPECT_TRUE(Collect(field, NoiseStore(), {frame}, order, options, pool, {}));
    };
    SensorPlate plate(80, 60);
    NoiseMoments moments(80, 60), expected(80, 60);
    collect(images, &plate, &moments);
    for (const SelectedImage& image : images) {
      SensorPlate of_image(80, 60);
      collect({&image, 1}, &of_image, nullptr);
      for (size_t i = 0; i < expected.size(); ++i)
        for (int c = 0; c < SensorPlate::kChannels; ++c) {
          const PlateElement at = expected.ElementAt(i);
          if (const ElementSum sum = of_image.At(at.x, at.y, c); sum.count > 0)
            expected.AddImage(i, c, sum);
        }
    }
    EXPECT_EQ(moments, expected);
    uint64_t measured = 0;
    for (size_t i = 0; i < moments.size(); ++i) measured += moments.At(i, 1).image_count;
    EXPECT_GT(measured, 10 * moments.size());
  }
}

TEST(Collect, TheReferenceAcceptsTheSameRays) {
  const NoiseStore store;
  CollectOptions options;
  const Outcome fast = CollectAll(store, 2, options);
  options.back_end = CollectBackEnd::kReference;
  const Outcome reference = CollectAll(store, 1, options);
  for (size_t f = 0; f < 3; ++f) {
    EXPECT_EQ(fast.statistics->frames[f].accepted_count,
              reference.statistics->frames[f].accepted_count);
    EXPECT_EQ(fast.statistics->frames[f].tested_count,
              reference.statistics->frames[f].tested_count);
    // In every channel, the sum of the counts is the number of accepted rays.
    uint64_t counts[3] = {};
    for (int y = 0; y < 60; ++y)
      for (int x = 0; x < 80; ++x)
        for (int c = 0; c < 3; ++c) counts[c] += fast.plates[f].At(x, y, c).count;
    for (const uint64_t count : counts) EXPECT_EQ(count, fast.statistics->frames[f].accepted_count);
  }
}

TEST(Collect, ABrokenImageLeavesTheBitsOfItsAbsence) {
  NoiseStore store;
  const Outcome absent = CollectAll(store, 2, {}, 0, {24, 30});
  store.broken = {24, 30};
  const Outcome broken = CollectAll(store, 2, {});
  ASSERT_TRUE(broken.statistics);
  EXPECT_EQ(broken.plates, absent.plates);
  ASSERT_EQ(broken.statistics->skipped.size(), 2u);
  std::vector<std::string> names = {broken.statistics->skipped[0].name,
                                    broken.statistics->skipped[1].name};
  std::sort(names.begin(), names.end());
  EXPECT_EQ(names, (std::vector<std::string>{"image24", "image30"}));
}

TEST(Collect, StrictMakesABrokenImageAnError) {
  NoiseStore store;
  store.broken = {24};
  CollectOptions options;
  options.strict = true;
  EXPECT_EQ(CollectAll(store, 2, options).statistics.error().message, "image24: broken");
}

TEST(Collect, WhatTheMachineLacksIsNotTakenForABrokenImage) {
  NoiseStore store;
  store.broken = {24};
  store.broken_kind = ErrorKind::kOutput;
  EXPECT_EQ(CollectAll(store, 2, {}).statistics.error().kind, ErrorKind::kOutput);
}

TEST(Collect, WantOfMemoryAndOtherExceptionsAreErrors) {
  NoiseStore store;
  store.without_memory = {24};
  const Outcome without_memory = CollectAll(store, 2, {});
  EXPECT_EQ(without_memory.statistics.error().kind, ErrorKind::kOutput);
  EXPECT_NE(without_memory.statistics.error().message.find("image24: too little memory"),
            std::string::npos);
}

TEST(Collect, StopsWhenInterrupted) {
  const NoiseStore store;
  const std::atomic<bool> interrupted = true;
  CollectOptions options;
  options.interrupted = &interrupted;
  EXPECT_EQ(CollectAll(store, 2, options).statistics.error().kind, ErrorKind::kInterrupted);
}

}  // namespace
}  // namespace lf
