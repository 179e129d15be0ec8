// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/preprocess/render_rate.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <memory>
#include <vector>

#include "lf/film/develop/frame_file.h"
#include "lf/rebinning/keep_pixels.h"
#include "lf/render/collect/collect.h"
#include "lf/render/collect/frame_lens.h"
#include "lf/render/hybrid/gap_lens.h"
#include "lf/render/hybrid/kept_store.h"
#include "lf/selection/image_order.h"
#include "lf/storage/load/open_store.h"

namespace lf {
namespace {

constexpr size_t kSampleImages = 16;

// Returns up to kSampleImages LF images whose files exist. The rank of each is its index in
// needs.images, because Collect() here does not need the order of the whole light field.
std::vector<SelectedImage> SampleOf(const FrameNeeds& needs, const LfImageStore& store) {
  constexpr size_t kMostAsked = 256;
  std::vector<SelectedImage> sample;
  for (size_t i = 0; i < std::min(kMostAsked, needs.images.size()); ++i) {
    const FrameNeeds::Image& image = needs.images[i];
    if (!store.IsThere(image.id)) continue;
    sample.push_back({image.id, static_cast<uint32_t>(i), image.rect, 1,
                      static_cast<uint64_t>(image.rect.pixel_count())});
    if (sample.size() == kSampleImages) break;
  }
  return sample;
}

// Returns the needs with their LF images in an order of groups.
FrameNeeds InGroups(const LightField& light_field, FrameNeeds needs) {
  const ImageRanks ranks = RanksOf(ImageOrder::kGroups, light_field, 0);
  const auto rank_of = [&](const FrameNeeds::Image& image) {
    return ranks.of_images[image.id.value];
  };
  std::sort(needs.images.begin(), needs.images.end(),
            [&](const auto& a, const auto& b) { return rank_of(a) < rank_of(b); });
  return needs;
}

// Loads LF images as a render does that only keeps their pixels. Leaves out broken ones.
std::vector<LfPixels> LoadSample(const LightField& light_field, const LfImageStore& store,
                                 std::vector<SelectedImage>* sample) {
  std::vector<LfPixels> loaded;
  std::vector<SelectedImage> whole;
  for (const SelectedImage& image : *sample) {
    Result<LfPixels> pixels = LoadWithoutThrowing(
        store, image.id, image.rect, light_field.image_names[image.id.value], LfPixels());
    if (!pixels) continue;
    loaded.push_back(*std::move(pixels));
    whole.push_back(image);
  }
  *sample = std::move(whole);
  return loaded;
}

// Keeps the pixels of the LF images, and collects `frame` from them.
Result<KeptRate> MeasureKept(const LightField& light_field, const std::vector<LfPixels>& loaded,
                             std::span<const SelectedImage> sample, CollectedFrame frame,
                             bool keeps_all, const NeedsOptions& needs,
                             const CollectOptions& options, ThreadPool& pool) {
  const std::vector<uint16_t> stored_values = StoredValueTable(light_field.encoding);
  uint64_t count = 0;
  std::vector<KeptImage> images;
  const ThreadCpuTimer timer;
  for (size_t i = 0; i < sample.size(); ++i) {
    const Intrinsics& k = light_field.Camera(sample[i].id).intrinsics;
    const PixelRect rect = Intersection(sample[i].rect, {0, 0, k.width_px, k.height_px});
    count += static_cast<uint64_t>(rect.pixel_count());
    images.push_back(
        KeepPixels(sample[i].id, k, loaded[i],
                   light_field.encoding.HasOpacity() ? loaded[i].opacity : Image<uint16_t>(),
                   std::span(&rect, 1), keeps_all, stored_values, needs.rebin.rebin));
  }
  const double keep_s = static_cast<double>(timer.Nanoseconds()) * 1e-9;
  KeptPixels kept(std::max<size_t>(1, count));
  kept.Add(std::move(images), pool);
  LF_ASSIGN_OR_RETURN(
      const CollectStatistics statistics,
      Collect(light_field, KeptStore(kept), {std::move(frame)}, sample, options, pool, nullptr));
  const double pixels = static_cast<double>(std::max<uint64_t>(1, count));
  return KeptRate{keep_s / pixels, statistics.times.load_cpu_s / pixels};
}

}  // namespace

Result<RenderRate> MeasureRate(const ImageIndex& index, const RenderCamera& frame,
                               size_t instant_count, const NeedsOptions& needs_options,
                               const RayReading& reading, const KeptReferences& kept,
                               ThreadPool& pool) {
  const LightField& light_field = index.light_field();
  const FrameNeeds needs = NeedsOf(index, frame, needs_options, pool);
  LF_ASSIGN_OR_RETURN(
      const std::unique_ptr<LfImageStore> opened,
      OpenStore(light_field, reading.estimator == Estimator::kBilinear ? Mosaics::kToRgb
                                                                       : Mosaics::kAsRecorded));
  const LfImageStore& store = *opened;
  const uint64_t reference_bytes = store.ReferenceBytes();
  if (reference_bytes > 0) opened->LimitReferences(kept.bytes);
  SensorPlate plate(frame.pinhole.intrinsics.width_px, frame.pinhole.intrinsics.height_px,
                    light_field.encoding.HasOpacity() ? PlateKind::kOpacity : PlateKind::kColours);
  std::vector<SelectedImage> sample = SampleOf(needs, store);
  if (sample.empty())
    return InputError(
        needs.images.empty()
            ? "the render time cannot be measured, because the frame needs no LF image"
            : fmt::format("{}: does not exist, and neither does any other LF image that was tried: "
                          "make the images accessible",
                          light_field.ImagePath(needs.images.front().id).string()));
  // Nothing else runs in this process, so its CPU time is the time that the pool's threads work.
  const std::clock_t lens_start = std::clock();
  const FrameLens lens(index, frame, needs_options.lens_weights, needs_options.select, pool);
  const double lens_s = static_cast<double>(instant_count) *
                        static_cast<double>(std::clock() - lens_start) / CLOCKS_PER_SEC;
  CollectOptions options;
  options.reading = reading;
  CollectedFrame collected = {lens.camera(), &plate};
  if (needs_options.lens_weights != LensWeights::kNone)
    collected.weights = [&lens](LfImageId id) { return lens.WeightsOf(id); };
  LF_ASSIGN_OR_RETURN(const CollectStatistics statistics,
                      Collect(light_field, store, {collected}, sample, options, pool, nullptr));
  const size_t loaded = sample.size() - statistics.skipped.size();
  if (loaded == 0) return InputError(statistics.skipped.front().reason);
  RenderRate rate;
  rate.load_s = statistics.times.load_cpu_s / static_cast<double>(loaded);
  if (reference_bytes > 0 && !kept.in_groups) {
    // The LF images of the sample are far apart, so that each has been decoded with all of its
    // reference images. In the render, as large a part of these is in memory as is kept. If it is
    // all, each LF image is decoded about once, as those of a group are one after another.
    const std::vector<SelectedImage> group = SampleOf(InGroups(light_field, needs), store);
    opened->LimitReferences(0);
    opened->LimitReferences(kept.bytes);
    SensorPlate again(plate.width(), plate.height(), plate.kind());
    collected.plate = &again;
    LF_ASSIGN_OR_RETURN(const CollectStatistics once,
                        Collect(light_field, store, {collected}, group, options, pool, nullptr));
    const double once_s = once.times.load_cpu_s / static_cast<double>(std::max<size_t>(
                                                      1, group.size() - once.skipped.size()));
    const double kept_share =
        std::min(1.0, static_cast<double>(kept.bytes) / static_cast<double>(reference_bytes));
    rate.load_s = once_s + (1 - kept_share) * std::max(0.0, rate.load_s - once_s);
  }
  rate.collect_s = statistics.times.collect_cpu_s /
                   static_cast<double>(std::max<uint64_t>(1, statistics.frames[0].tested_count));

  if (needs_options.KeepsPixels()) {
    const ThreadCpuTimer load_timer;
    const std::vector<LfPixels> pixels = LoadSample(light_field, store, &sample);
    // An LF image that no frame is collected from is not filtered.
    if (!Collects(needs_options.mode))
      rate.load_s =
          std::min(rate.load_s, static_cast<double>(load_timer.Nanoseconds()) * 1e-9 /
                                    static_cast<double>(std::max<size_t>(1, pixels.size())));
    SensorPlate again(plate.width(), plate.height(), plate.kind());
    collected.plate = &again;
    for (const bool keeps_all : {true, false}) {
      LF_ASSIGN_OR_RETURN(keeps_all ? rate.all : rate.edges,
                          MeasureKept(light_field, pixels, sample, collected, keeps_all,
                                      needs_options, options, pool));
    }
    const std::clock_t gap_start = std::clock();
    if (Collects(needs_options.mode)) GapLens(index, frame, lens, {}, needs_options.select, pool);
    rate.gaps_s = static_cast<double>(instant_count) *
                  static_cast<double>(std::clock() - gap_start) / CLOCKS_PER_SEC;
  }

  ThreadPool alone(1);
  const ThreadCpuTimer timer;
  DevelopOptions develop;
  develop.pedestal = light_field.encoding.pedestal;
  develop.scale = light_field.encoding.Scale();
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / fmt::format("lf_rate.{}.exr", ::getpid());
  DevelopedFrame developed = Develop(plate, develop, alone);
  if (needs_options.lens_weights != LensWeights::kNone)
    developed.effective_count =
        SpreadOverPlate(lens.EffectiveCounts(), lens.camera().pinhole.intrinsics);
  const Result<void> written = WriteFrame(file, developed, FrameFormat::kExrHalf, {});
  std::error_code ignored;
  std::filesystem::remove(file, ignored);
  LF_RETURN_IF_ERROR(written);
  rate.finish_s = lens_s + static_cast<double>(timer.Nanoseconds()) * 1e-9;
  return rate;
}

}  // namespace lf
