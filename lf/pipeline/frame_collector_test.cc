#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

#include "lf/pipeline/collect.h"
#include "lf/pipeline/test_noise_field.h"
#include "lf/selection/overlap.h"

namespace lf {
namespace {

constexpr uint32_t kSide = 14;  // more than 128 LF images contribute: two decisions

struct Job {
  const LightField field = testing::NoiseField(kSide);
  const std::vector<RenderCamera> frames = testing::NoiseFrames();
  ThreadPool pool{2};
  const std::vector<SelectedImage> order = SelectImages(field, frames, {3, {}}, pool);
  testing::NoiseStore store;
  CollectOptions options;
  std::vector<SensorPlate> plates = EmptyPlates();
  std::vector<FrameProgress> start = std::vector<FrameProgress>(frames.size());

  std::vector<SensorPlate> EmptyPlates() const {
    std::vector<SensorPlate> empty;
    for (size_t i = 0; i < frames.size(); ++i) empty.emplace_back(80, 60);
    return empty;
  }
  FrameCollector Collector() {
    return FrameCollector(field, store, frames, order, start, options, pool, &plates);
  }
};

// Frame f alone, of places [begin, end) of the order.
SensorPlate PlateOf(Job& job, size_t f, size_t end, FrameRays* rays) {
  std::vector<SensorPlate> plates;
  plates.emplace_back(80, 60);
  CollectOptions options = job.options;
  options.interrupted = nullptr;
  const Result<CollectStatistics> statistics =
      Collect(job.field, job.store, std::span(job.frames).subspan(f, 1),
              std::span(job.order).first(end), options, job.pool, &plates, nullptr);
  EXPECT_TRUE(statistics);
  *rays = statistics->frames[0];
  return std::move(plates[0]);
}

void ExpectConsistent(Job& job, std::span<const FrameProgress> progress) {
  for (size_t f = 0; f < job.frames.size(); ++f) {
    FrameRays rays;
    EXPECT_EQ(job.plates[f], PlateOf(job, f, progress[f].places_done, &rays)) << f;
    EXPECT_EQ(progress[f].rays.image_count, rays.image_count);
    EXPECT_EQ(progress[f].rays.tested_count, rays.tested_count);
    EXPECT_EQ(progress[f].rays.accepted_count, rays.accepted_count);
  }
}

TEST(FrameCollector, NoBatchGoesAcrossADecision) {
  for (const int batch_image_count : {1, 10, 64, 100}) {
    Job job;
    job.options.batch_image_count = batch_image_count;
    FrameCollector collector = job.Collector();
    std::vector<size_t> ends;
    while (*collector.Step()) {
      ends.push_back(collector.place());
      for (const FrameProgress& frame : collector.frames())
        EXPECT_EQ(frame.places_done, collector.place());
    }
    for (const size_t decision : {size_t{64}, size_t{128}, job.order.size()})
      EXPECT_EQ(std::count(ends.begin(), ends.end(), decision), 1) << batch_image_count;
    ExpectConsistent(job, collector.frames());
  }
}

TEST(FrameCollector, FramesThatStartApartCatchUp) {
  Job job;
  job.options.batch_image_count = 10;
  const size_t places[] = {37, 0, 64};
  for (size_t f = 0; f < 3; ++f) {
    job.start[f].places_done = places[f];
    job.plates[f] = PlateOf(job, f, places[f], &job.start[f].rays);
  }
  std::atomic<int> load_count = 0;
  job.store.on_load = [&](LfImageId, const PixelRect&) { ++load_count; };
  FrameCollector collector = job.Collector();
  while (*collector.Step()) continue;
  // Once each, but for those that no frame behind needs.
  EXPECT_LE(load_count, static_cast<int>(job.order.size()));
  EXPECT_GT(load_count, static_cast<int>(job.order.size()) - 37);
  ExpectConsistent(job, collector.frames());
}

TEST(FrameCollector, WhatNoFrameWantsIsNotRead) {
  Job job;
  for (FrameProgress& frame : job.start) frame.places_done = 100;
  std::atomic<int> load_count = 0;
  job.store.on_load = [&](LfImageId, const PixelRect&) { ++load_count; };
  FrameCollector collector = job.Collector();
  EXPECT_EQ(collector.place(), 100u);
  while (*collector.Step()) continue;
  EXPECT_EQ(load_count, static_cast<int>(job.order.size()) - 100);
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
  for (size_t place = 0; place < job.order.size(); ++place)
    EXPECT_EQ(job.store.announced[place], job.order[place].id.value);
}

TEST(FrameCollector, OnlyWhatFramesStillNeedIsDecoded) {
  Job job;
  for (const size_t f : {size_t{0}, size_t{2}}) job.start[f].places_done = job.order.size();
  job.store.on_load = [&](LfImageId id, const PixelRect& rect) {
    EXPECT_EQ(rect, ContributingRect(job.field.Camera(id), job.frames[1]));
  };
  FrameCollector collector = job.Collector();
  while (*collector.Step()) continue;
  job.store.on_load = nullptr;
  FrameRays rays;
  EXPECT_EQ(job.plates[1], PlateOf(job, 1, job.order.size(), &rays));
}

TEST(FrameCollector, AStoppedFrameTakesNoMore) {
  Job job;
  job.options.batch_image_count = 64;
  FrameCollector collector = job.Collector();
  EXPECT_TRUE(*collector.Step());
  collector.Stop(1);
  EXPECT_TRUE(*collector.Step());
  EXPECT_EQ(collector.frames()[1].places_done, 64u);
  EXPECT_EQ(collector.frames()[2].places_done, 128u);
  collector.Stop(0);
  collector.Stop(2);
  EXPECT_FALSE(*collector.Step());
  ExpectConsistent(job, collector.frames());
}

TEST(FrameCollector, InterruptedAnywhereEveryFrameIsConsistent) {
  Job whole;
  FrameCollector of_all = whole.Collector();
  while (*of_all.Step()) continue;
  for (int delay_us = 0; delay_us < 30000; delay_us += 1500) {
    Job job;
    std::atomic<bool> interrupted = false;
    job.options.interrupted = &interrupted;
    std::vector<FrameProgress> reached;
    {
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
      reached.assign(collector.frames().begin(), collector.frames().end());
      ExpectConsistent(job, reached);
      // This one may go on, after a look at the plates, say.
      interrupted = delay_us % 2000 != 0;
      if (!interrupted) {
        while (*collector.Step()) continue;
        reached.assign(collector.frames().begin(), collector.frames().end());
      }
    }
    // So may another.
    interrupted = false;
    job.start = reached;
    FrameCollector collector = job.Collector();
    while (*collector.Step()) continue;
    EXPECT_EQ(job.plates, whole.plates);
    for (size_t f = 0; f < 3; ++f)
      EXPECT_EQ(collector.frames()[f].rays.accepted_count, of_all.frames()[f].rays.accepted_count);
  }
}

TEST(FrameCollector, BrokenImagesArePlaces) {
  Job job;
  job.store.broken = {job.order[5].id.value, job.order[70].id.value};
  FrameCollector collector = job.Collector();
  while (*collector.Step()) continue;
  EXPECT_EQ(collector.frames()[0].places_done, job.order.size());
  ASSERT_EQ(collector.skipped().size(), 2u);
  EXPECT_EQ(collector.skipped()[0].place, 5u);
  EXPECT_EQ(collector.skipped()[1].place, 70u);
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
