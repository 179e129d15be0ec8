// SPDX-License-Identifier: Apache-2.0
#include "lf/render/hybrid/rebinned_rays.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "lf/render/collect/collect.h"
#include "lf/render/collect/frame_lens.h"
#include "lf/render/collect/test_noise_field.h"

namespace lf {
namespace {

struct Fixture {
  LightField field = testing::NoiseField(11);
  ImageIndex index{field, 5};
  std::vector<RenderCamera> frames = testing::NoiseFrames();
  SelectOptions select;
  RebinSettings options;
  bool collects = true;

  Fixture() {
    select.reach = PixelReach::kElement;
    options.max_cells = 4000000;
    options.previews = Previews::kOn;
    frames[2].aperture.radius_w = 0.0004;  // a small lens between the LF cameras
  }

  std::unique_ptr<RebinnedRays> Make(ThreadPool& pool) const {
    CollectedWeights collected;
    if (collects) collected = [](LfImageId) { return RayWeights(1); };
    std::vector<SampledFrame> sampled;
    std::vector<RebinnedFrame> rebinned;
    for (const RenderCamera& frame : frames) {
      sampled.push_back({frame, SamplingOf(index, frame, select, pool)});
      rebinned.push_back(
          {FrameId{static_cast<uint32_t>(sampled.size())},
           LensGaps(index, frame, collected, true, {}, select, options.query, pool)});
    }
    const FilmSlabs slabs(sampled, 1, options.query, options.slab);
    return std::make_unique<RebinnedRays>(index, slabs, std::move(rebinned), collects, select,
                                          options, pool);
  }

  struct Outcome {
    std::vector<SensorPlate> plates;
    std::vector<Completion> completions;
    std::vector<size_t> cells;
  };

  // Collects all batches. After `interrupted_after` batches, it copies the maps to a new
  // RebinnedRays, as a render that resumes does.
  Outcome Run(int threads, int batch, size_t interrupted_after = SIZE_MAX) const {
    ThreadPool pool(threads);
    const testing::NoiseStore store;
    Outcome outcome;
    std::vector<RankRange> ranks(frames.size());
    for (const RenderCamera& frame : frames)
      outcome.plates.emplace_back(frame.pinhole.intrinsics.width_px,
                                  frame.pinhole.intrinsics.height_px);
    std::unique_ptr<RebinnedRays> rays = Make(pool);
    for (int round = 0; round < 2; ++round) {
      std::vector<TakingFrame> taking;
      for (size_t f = 0; f < frames.size(); ++f) {
        if (collects) taking.push_back({frames[f], ranks[f]});
        if (const RenderCamera* const reached = rays->ReachedCamera(f))
          taking.push_back({*reached, {rays->ranks_done()}});
      }
      const auto order = SelectImages(index, taking, select, pool);
      CollectOptions collect;
      collect.reading.estimator = Estimator::kBilinear;
      collect.batch_image_count = batch;
      collect.consumer = rays.get();
      const size_t count = collects ? frames.size() : 0;
      std::vector<CollectedFrame> collected =
          FramesOf(std::span(frames).first(count), outcome.plates);
      for (size_t f = 0; f < count; ++f) collected[f].ranks = ranks[f];
      FrameCollector collector(field, store, std::move(collected), order, collect, pool);
      for (size_t step = 0; step < interrupted_after; ++step)
        if (!*collector.Step()) break;
      if (interrupted_after == SIZE_MAX) break;
      interrupted_after = SIZE_MAX;
      for (size_t f = 0; f < count; ++f) ranks[f].begin = collector.frames()[f].progress.ranks_done;
      std::unique_ptr<RebinnedRays> again = Make(pool);
      for (size_t i = 0; i < rays->section_count(); ++i)
        again->Restore(i, RayMap(rays->map(i)), rays->ranks_done(i));
      rays = std::move(again);
    }
    for (size_t f = 0; f < frames.size(); ++f)
      outcome.completions.push_back(rays->Complete(f, LensGaps::kInTheEnd));
    for (size_t i = 0; i < rays->section_count(); ++i) outcome.cells.push_back(rays->map(i).size());
    return outcome;
  }
};

void ExpectSame(const Fixture::Outcome& a, const Fixture::Outcome& b) {
  EXPECT_EQ(a.cells, b.cells);
  for (size_t f = 0; f < a.completions.size(); ++f) {
    EXPECT_EQ(a.completions[f].rgb.pixels(), b.completions[f].rgb.pixels());
    EXPECT_EQ(a.completions[f].share.pixels(), b.completions[f].share.pixels());
    EXPECT_TRUE(a.plates[f] == b.plates[f]);
  }
}

double MeanShare(const Completion& completion) {
  double sum = 0;
  for (const float share : completion.share.pixels()) sum += share;
  return sum / static_cast<double>(completion.share.pixels().size());
}

TEST(RebinnedRays, CompletesWhatIsNotCollectedAndLeavesThePlatesAlone) {
  const Fixture fixture;
  const Fixture::Outcome outcome = fixture.Run(2, 16);
  EXPECT_LT(MeanShare(outcome.completions[1]), 0.3);
  EXPECT_GT(MeanShare(outcome.completions[2]), 0.7);

  ThreadPool pool(2);
  std::vector<SensorPlate> plates;
  for (const RenderCamera& frame : fixture.frames)
    plates.emplace_back(frame.pinhole.intrinsics.width_px, frame.pinhole.intrinsics.height_px);
  CollectOptions collect;
  collect.reading.estimator = Estimator::kBilinear;
  const auto order = SelectImages(fixture.index, fixture.frames, fixture.select, pool);
  ASSERT_TRUE(Collect(fixture.field, testing::NoiseStore(), FramesOf(fixture.frames, plates), order,
                      collect, pool, {}));
  for (size_t f = 0; f < plates.size(); ++f) EXPECT_TRUE(plates[f] == outcome.plates[f]);
}

TEST(RebinnedRays, TheSameForAnyThreadsBatchesAndInterruptions) {
  for (const bool collects : {true, false})
    for (const KeptRays kept : {KeptRays::kAuto, KeptRays::kEdges}) {
      Fixture fixture;
      fixture.collects = collects;
      fixture.options.kept = kept;
      if (kept == KeptRays::kEdges) fixture.options.max_cells = 900;  // far too few cells
      const Fixture::Outcome expected = fixture.Run(1, 16);
      EXPECT_GT(MeanShare(expected.completions[2]), 0.01);
      for (const size_t cells : expected.cells) EXPECT_LE(cells, fixture.options.max_cells);
      ExpectSame(expected, fixture.Run(3, 5));
      for (const size_t steps : {1, 4, 6}) ExpectSame(expected, fixture.Run(2, 16, steps));
    }
}

TEST(RebinnedRays, OthersMayBeAveragedInTheSameWayEachTime) {
  Fixture fixture;
  fixture.options.kept = KeptRays::kEdges;
  fixture.options.rebin.probability.alpha = 0.01;  // low enough for edges everywhere in the noise
  fixture.options.slab.r_st_w = 0.01;              // cells so wide that many rays share one
  fixture.options.slab.r_uv_w = 0.03;
  const Fixture::Outcome plain = fixture.Run(1, 16);
  fixture.options.rebin.averages_others = true;
  const Fixture::Outcome expected = fixture.Run(1, 16);
  ExpectSame(expected, fixture.Run(3, 7));
  EXPECT_EQ(expected.cells, plain.cells);
  EXPECT_NE(expected.completions[2].rgb.pixels(), plain.completions[2].rgb.pixels());
}

// While few LF images are collected, rays are kept for previews; later, only the rays that finished
// frames need.
TEST(RebinnedRays, PreviewsAskForMoreThanTheFinishedFrames) {
  ThreadPool pool(2);
  const Fixture fixture;
  const std::unique_ptr<RebinnedRays> rays = fixture.Make(pool);
  const testing::NoiseStore store;
  const uint32_t end = fixture.index.rank_end();
  std::vector<BatchImage> images(fixture.field.size());
  for (uint32_t i = 0; i < images.size(); ++i) {
    BatchImage& image = images[fixture.index.RankOf(LfImageId{i})];
    image.id = LfImageId{i};
    image.rank = fixture.index.RankOf(image.id);
    ASSERT_TRUE(store.Load(image.id, {0, 0, testing::kWidth, testing::kHeight}, &image.pixels));
  }
  ASSERT_GT(end, 64u);
  EXPECT_GT(rays->RectOf(images[3].id, 3).pixel_count(), 0);
  rays->Take(std::span(images).first(64), 64);
  EXPECT_EQ(rays->ranks_done(), 64u);
  const double share = MeanShare(rays->Complete(1, 20));
  const size_t before = rays->facts().cell_count;
  rays->Take(std::span(images).subspan(64), end);
  EXPECT_LT(MeanShare(rays->Complete(1, end)), share - 0.1);
  Fixture without;
  without.options.previews = Previews::kOff;
  const Fixture::Outcome outcome = without.Run(1, 16);
  // The two counts differ by cells at the borders of the covered region.
  EXPECT_NEAR(static_cast<double>(rays->facts().cell_count) / static_cast<double>(outcome.cells[0]),
              1, 0.4);
  EXPECT_GT(before, outcome.cells[0] * 64 / end);
}

// With Previews::kAuto, frames that collect few LF images have no previews; with kOn they have.
TEST(RebinnedRays, PreviewsAreOfFramesThatTakeLong) {
  ThreadPool pool(1);
  Fixture fixture;
  ASSERT_LT(fixture.field.size(), kPreviewedFrom);
  const testing::NoiseStore store;
  const auto looked_at = [&](Previews previews) {
    fixture.options.previews = previews;
    const std::unique_ptr<RebinnedRays> rays = fixture.Make(pool);
    BatchImage image;
    for (uint32_t i = 0; i < fixture.field.size(); ++i)
      if (fixture.index.RankOf(LfImageId{i}) == 0) image.id = LfImageId{i};
    EXPECT_TRUE(store.Load(image.id, {0, 0, testing::kWidth, testing::kHeight}, &image.pixels));
    rays->Take(std::span(&image, 1), 1);
    return rays->facts().looked_at;
  };
  EXPECT_GT(looked_at(Previews::kOn), looked_at(Previews::kAuto));
  EXPECT_EQ(looked_at(Previews::kOff), looked_at(Previews::kAuto));
}

TEST(RebinnedRays, WithoutRoomTheRaysAtEdgesAreKept) {
  ThreadPool pool(1);
  Fixture fixture;
  EXPECT_TRUE(fixture.Make(pool)->facts().keeps_all);
  fixture.options.max_cells = 1000;
  EXPECT_FALSE(fixture.Make(pool)->facts().keeps_all);
}

}  // namespace
}  // namespace lf
