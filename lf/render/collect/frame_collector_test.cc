// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <utility>
#include <vector>

#include "lf/render/collect/collect.h"
#include "lf/render/collect/test_noise_field.h"
#include "lf/selection/overlap.h"

namespace lf {
namespace {

// LF cameras per side of the grid. More than 128 LF images contribute, so that a stop rule would be
// applied twice: at ranks 64 and 128.
constexpr uint32_t kSide = 14;

// Returns a reading that filters LF images before it interpolates between their pixels.
RayReading Prefiltered() {
  RayReading reading = Estimator::kBilinear;
  reading.filter = PixelFilter::kPrefiltered;
  return reading;
}

struct Job {
  explicit Job(const RayReading& reading = Estimator::kNearest) {
    options.reading = reading;
    SelectOptions select;
    select.reach = ReachOf(reading);
    order = SelectImages(ImageIndex(field, 3), frames, select, pool);
  }

  const LightField field = testing::NoiseField(kSide);
  const std::vector<RenderCamera> frames = testing::NoiseFrames();
  ThreadPool pool{2};
  std::vector<SelectedImage> order;
  testing::NoiseStore store;
  CollectOptions options;
  std::vector<SensorPlate> plates = EmptyPlates();
  std::vector<RankRange> ranks = std::vector<RankRange>(frames.size());

  std::vector<SensorPlate> EmptyPlates() const {
    std::vector<SensorPlate> empty;
    for (size_t i = 0; i < frames.size(); ++i) empty.emplace_back(80, 60);
    return empty;
  }
  FrameCollector Collector() {
    std::vector<CollectedFrame> collected = FramesOf(frames, plates);
    for (size_t f = 0; f < collected.size(); ++f) collected[f].ranks = ranks[f];
    return FrameCollector(field, store, std::move(collected), order, options, pool);
  }
};

// Collects frame f alone, from ranks [0, end) of the order.
SensorPlate PlateOf(Job& job, size_t f, uint32_t end, FrameRays* rays) {
  std::vector<SensorPlate> plates;
  plates.emplace_back(80, 60);
  std::vector<SelectedImage> images = job.order;
  std::erase_if(images, [&](const SelectedImage& image) { return image.rank >= end; });
  CollectOptions options = job.options;
  options.interrupted = nullptr;
  const auto on_load = std::exchange(job.store.on_load, nullptr);
  const Result<CollectStatistics> statistics =
      Collect(job.field, job.store, FramesOf(std::span(job.frames).subspan(f, 1), plates), images,
              options, job.pool, nullptr);
  job.store.on_load = on_load;
  EXPECT_TRUE(statistics);
  *rays = statistics->frames[0];
  return std::move(plates[0]);
}

void ExpectPlates(Job& job, std::span<const CollectedFrame> frames) {
  for (size_t f = 0; f < job.frames.size(); ++f) {
    FrameRays rays;
    EXPECT_EQ(job.plates[f], PlateOf(job, f, frames[f].progress.ranks_done, &rays)) << f;
  }
}

void ExpectRays(Job& job, std::span<const CollectedFrame> frames) {
  for (size_t f = 0; f < job.frames.size(); ++f) {
    FrameRays rays;
    PlateOf(job, f, frames[f].progress.ranks_done, &rays);
    EXPECT_EQ(frames[f].progress.rays.image_count, rays.image_count);
    EXPECT_EQ(frames[f].progress.rays.tested_count, rays.tested_count);
    EXPECT_EQ(frames[f].progress.rays.accepted_count, rays.accepted_count);
  }
}

TEST(FrameCollector, NoBatchGoesAcrossADecision) {
  for (const int batch_image_count : {1, 10, 64, 100}) {
    Job job;
    job.options.batch_image_count = batch_image_count;
    FrameCollector collector = job.Collector();
    std::vector<uint32_t> ends;
    size_t images_done = 0;
    while (*collector.Step()) {
      ends.push_back(collector.frames()[0].progress.ranks_done);
      for (const CollectedFrame& frame : collector.frames())
        EXPECT_EQ(frame.progress.ranks_done, ends.back());
      EXPECT_LE(collector.images_done() - images_done, static_cast<size_t>(batch_image_count));
      images_done = collector.images_done();
      const size_t images_before =
          std::count_if(job.order.begin(), job.order.end(),
                        [&](const SelectedImage& image) { return image.rank < ends.back(); });
      EXPECT_EQ(images_done, images_before);
    }
    for (const uint32_t decision : {64u, 128u, kSide * kSide})
      EXPECT_EQ(std::count(ends.begin(), ends.end(), decision), 1) << batch_image_count;
    ExpectPlates(job, collector.frames());
    ExpectRays(job, collector.frames());
  }
}

TEST(FrameCollector, WithoutRulesBatchesAreNotCut) {
  Job job;
  job.options.batch_image_count = 100;
  job.options.decision_ranks = 0;
  FrameCollector collector = job.Collector();
  EXPECT_TRUE(*collector.Step());
  EXPECT_EQ(collector.images_done(), 100u);
}

TEST(FrameCollector, FramesThatStartApartCatchUp) {
  Job job;
  job.options.batch_image_count = 10;
  const uint32_t ranks[] = {37, 0, 64};
  for (size_t f = 0; f < 3; ++f) {
    job.ranks[f].begin = ranks[f];
    FrameRays rays;
    job.plates[f] = PlateOf(job, f, ranks[f], &rays);
  }
  std::atomic<size_t> load_count = 0;
  job.store.on_load = [&](LfImageId, const PixelRect&) { ++load_count; };
  FrameCollector collector = job.Collector();
  while (*collector.Step()) continue;
  // Each LF image is loaded at most once, and an LF image that no frame still needs is not loaded.
  EXPECT_LE(load_count, job.order.size());
  EXPECT_GT(load_count, job.order.size() - 37);
  ExpectPlates(job, collector.frames());
}

TEST(FrameCollector, FramesThatEndApart) {
  Job job;
  const uint32_t ends[] = {37, UINT32_MAX, 64};
  for (size_t f = 0; f < 3; ++f) job.ranks[f].end = ends[f];
  FrameCollector collector = job.Collector();
  while (*collector.Step()) continue;
  EXPECT_EQ(collector.frames()[0].progress.ranks_done, 37u);
  EXPECT_EQ(collector.frames()[1].progress.ranks_done, kSide * kSide);
  EXPECT_EQ(collector.frames()[2].progress.ranks_done, 64u);
  ExpectPlates(job, collector.frames());
  ExpectRays(job, collector.frames());
}

TEST(FrameCollector, WhatNoFrameWantsIsNotRead) {
  Job job;
  for (RankRange& range : job.ranks) range.begin = 100;
  std::atomic<int> load_count = 0;
  job.store.on_load = [&](LfImageId, const PixelRect&) { ++load_count; };
  FrameCollector collector = job.Collector();
  while (*collector.Step()) continue;
  EXPECT_EQ(load_count,
            std::count_if(job.order.begin(), job.order.end(),
                          [](const SelectedImage& image) { return image.rank >= 100; }));
}

TEST(FrameCollector, LongBatchesAreCut) {
  Job job;
  job.options.batch_image_count = 64;
  job.options.batch_frame_ray_count = 10 * testing::kWidth * testing::kHeight;
  FrameCollector collector = job.Collector();
  EXPECT_TRUE(*collector.Step());
  EXPECT_GE(collector.images_done(), 10u);
  EXPECT_LT(collector.images_done(), 40u);
  job.options.batch_ray_count = 1;
  FrameCollector one_by_one = job.Collector();
  EXPECT_TRUE(*one_by_one.Step());
  EXPECT_EQ(one_by_one.images_done(), 1u);
}

TEST(FrameCollector, TheNextBatchIsDecodedMeanwhile) {
  Job job;
  job.options.batch_image_count = 10;
  std::atomic<int> load_count = 0;
  job.store.on_load = [&](LfImageId, const PixelRect&) { ++load_count; };
  FrameCollector collector = job.Collector();
  EXPECT_TRUE(*collector.Step());
  EXPECT_EQ(load_count, 20);
  EXPECT_TRUE(*collector.Step());
  EXPECT_EQ(load_count, 30);
}

TEST(FrameCollector, ImagesAreAnnouncedOnceAndAhead) {
  Job job;
  job.options.batch_image_count = 10;
  FrameCollector collector = job.Collector();
  EXPECT_TRUE(*collector.Step());
  EXPECT_EQ(job.store.announced.size(), 30u);
  while (*collector.Step()) continue;
  ASSERT_EQ(job.store.announced.size(), job.order.size());
  for (size_t rank = 0; rank < job.order.size(); ++rank)
    EXPECT_EQ(job.store.announced[rank], job.order[rank].id.value);
}

TEST(FrameCollector, OnlyWhatFramesStillNeedIsDecoded) {
  Job job;
  for (const size_t f : {size_t{0}, size_t{2}}) job.ranks[f].begin = kSide * kSide;
  job.store.on_load = [&](LfImageId id, const PixelRect& rect) {
    EXPECT_EQ(rect, ContributingRect(job.field.Camera(id), job.frames[1]));
  };
  FrameCollector collector = job.Collector();
  while (*collector.Step()) continue;
  FrameRays rays;
  EXPECT_EQ(job.plates[1], PlateOf(job, 1, kSide * kSide, &rays));
}

TEST(FrameCollector, AStoppedFrameTakesNoMore) {
  Job job;
  job.options.batch_image_count = 64;
  FrameCollector collector = job.Collector();
  EXPECT_TRUE(*collector.Step());
  collector.Stop(1);
  EXPECT_TRUE(*collector.Step());
  EXPECT_EQ(collector.frames()[1].progress.ranks_done, 64u);
  EXPECT_EQ(collector.frames()[2].progress.ranks_done, 128u);
  collector.Stop(0);
  collector.Stop(2);
  EXPECT_FALSE(*collector.Step());
  ExpectPlates(job, collector.frames());
  ExpectRays(job, collector.frames());
}

void ExpectConsistentIfInterrupted(const RayReading& reading) {
  Job whole(reading);
  FrameCollector of_all = whole.Collector();
  while (*of_all.Step()) continue;
  for (int delay_us = 0; delay_us < 30000; delay_us += 1500) {
    Job job(reading);
    std::atomic<bool> interrupted = false;
    job.options.interrupted = &interrupted;
    FrameCollector collector = job.Collector();
    std::thread user([&] {
      std::this_thread::sleep_for(std::chrono::microseconds(delay_us));
      interrupted = true;
    });
    Result<bool> step = true;
    while (step && *step) step = collector.Step();
    user.join();
    if (!step) {
      EXPECT_EQ(step.error().kind, ErrorKind::kInterrupted);
    }
    ExpectPlates(job, collector.frames());
    ExpectRays(job, collector.frames());

    // After the plates were compared, either this collector continues or a new one does.
    interrupted = false;
    if (delay_us % 2000 == 0) {
      while (*collector.Step()) continue;
      ExpectRays(job, collector.frames());
    } else {
      for (size_t f = 0; f < 3; ++f) job.ranks[f].begin = collector.frames()[f].progress.ranks_done;
      FrameCollector another = job.Collector();
      while (*another.Step()) continue;
      for (size_t f = 0; f < 3; ++f)
        EXPECT_EQ(collector.frames()[f].progress.rays.accepted_count +
                      another.frames()[f].progress.rays.accepted_count,
                  of_all.frames()[f].progress.rays.accepted_count);
    }
    EXPECT_EQ(job.plates, whole.plates);
  }
}

TEST(FrameCollector, InterruptedAnywhereEveryFrameIsConsistent) {
  ExpectConsistentIfInterrupted(Estimator::kNearest);
}

// The LF images of an interrupted batch may have been filtered in place already.
TEST(FrameCollector, InterruptedBetweenPrefiltersEveryFrameIsConsistent) {
  ExpectConsistentIfInterrupted(Prefiltered());
}

TEST(FrameCollector, BrokenImagesArePlaces) {
  Job job;
  job.store.broken = {job.order[5].id.value, job.order[70].id.value};
  FrameCollector collector = job.Collector();
  while (*collector.Step()) continue;
  ASSERT_EQ(collector.skipped().size(), 2u);
  EXPECT_EQ(collector.skipped()[0].rank, job.order[5].rank);
  EXPECT_EQ(collector.skipped()[1].rank, job.order[70].rank);
}

TEST(FrameCollector, ALightFieldThatVanishesIsNotSkipped) {
  Job job;
  job.options.batch_image_count = 10;
  FrameCollector collector = job.Collector();
  ASSERT_TRUE(*collector.Step());
  ASSERT_TRUE(*collector.Step());
  const size_t done = collector.images_done();
  // From here on, no LF image can be read.
  for (const SelectedImage& image : job.order) job.store.broken.push_back(image.id.value);
  job.store.is_gone = true;
  Result<bool> step = true;
  while (step && *step) step = collector.Step();
  ASSERT_FALSE(step);
  EXPECT_EQ(step.error().kind, ErrorKind::kInput);
  EXPECT_NE(step.error().message.find("does not exist any more"), std::string::npos);
  EXPECT_TRUE(collector.skipped().empty());
  EXPECT_LE(collector.images_done(), done + 10);  // one more batch may have been decoded already

  // The LF images can be read again.
  job.store.broken.clear();
  job.store.is_gone = false;
  ExpectPlates(job, collector.frames());
  for (size_t f = 0; f < 3; ++f) job.ranks[f].begin = collector.frames()[f].progress.ranks_done;
  FrameCollector another = job.Collector();
  while (*another.Step()) continue;
  Job whole;
  FrameCollector of_all = whole.Collector();
  while (*of_all.Step()) continue;
  EXPECT_EQ(job.plates, whole.plates);
}

TEST(FrameCollector, TellsWhereTheTimeWent) {
  Job job;
  FrameCollector collector = job.Collector();
  while (*collector.Step()) continue;
  EXPECT_GT(collector.times().load_cpu_s, 0);
  EXPECT_GT(collector.times().collect_cpu_s, 0);
  EXPECT_GT(collector.times().wall_s, 0);
}

}  // namespace
}  // namespace lf
