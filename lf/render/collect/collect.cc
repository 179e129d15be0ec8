// SPDX-License-Identifier: Apache-2.0
#include "lf/render/collect/collect.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <mutex>
#include <new>
#include <optional>
#include <utility>

#include "lf/core/log.h"
#include "lf/render/collect/noise_rule.h"
#include "lf/render/collect/opacity_and_trust.h"
#include "lf/selection/overlap.h"

namespace lf {
namespace {

using Clock = std::chrono::steady_clock;

double SecondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// An LF image of a batch while it is decoded.
struct Loading {
  size_t index = 0;                                       // index of the LF image in State::order_
  std::optional<Result<LfPixels>> pixels = std::nullopt;  // without opacity and trust
  LfPixels opacity = {};                                  // BatchImage::opacity
  NearbyDepths depths = {};
  PixelRect rect = {};  // of the pixels, before they were filtered
  std::optional<Prefilter> filtered_by = std::nullopt;
};

// A batch: the LF images with indices [begin, end) in State::order_.
struct Batch {
  size_t begin = 0;
  size_t end = 0;
  uint32_t rank_end = 0;  // when the batch is done, all ranks before this one are done
  // Indices of the frames that take the batch. Empty: all; or none, if only the consumer needs it.
  std::vector<size_t> frames;
  std::vector<Loading> loading;
  std::vector<BatchImage> images;  // LF images that are not broken; set once all are loaded
  bool is_loaded = false;
};

}  // namespace

class FrameCollector::State {
 public:
  State(const LightField& light_field, const LfImageStore& store,
        std::vector<CollectedFrame> frames, std::span<const SelectedImage> order,
        const CollectOptions& options, ThreadPool& pool)
      : light_field_(light_field),
        store_(store),
        order_(order),
        options_(options),
        pool_(pool),
        frames_(std::move(frames)),
        collector_(light_field, frames_, options.reading, options.back_end, options.plan_bytes,
                   options.whole_images, pool) {
    for (CollectedFrame& frame : frames_) frame.progress.ranks_done = frame.ranks.begin;
    LF_CHECK(options.batch_image_count >= 1);
    images_done_ = announced_ = FirstWanted(0);
    most_values_ = MostValues();
  }

  Result<bool> Step();

  std::vector<CollectedFrame>& frames() { return frames_; }
  const std::vector<SkippedImage>& skipped() const { return skipped_; }
  const CollectTimes& times() const { return times_; }
  size_t images_done() const { return images_done_; }

 private:
  bool IsInterrupted() const { return options_.interrupted != nullptr && *options_.interrupted; }
  Error Interruption() const {
    return {ErrorKind::kInterrupted,
            fmt::format("interrupted after {} of {} LF images", images_done_, order_.size())};
  }
  static bool Takes(const CollectedFrame& frame) {
    return !frame.is_stopped && frame.progress.ranks_done < frame.ranks.end;
  }
  // True if options_.consumer still needs LF images at ranks before rank_end.
  bool ConsumerWants(uint32_t rank_end) const {
    return options_.consumer != nullptr && options_.consumer->ranks_done() < rank_end;
  }
  uint32_t RankEnd() const {
    return options_.rank_end > 0 ? options_.rank_end : static_cast<uint32_t>(light_field_.size());
  }
  size_t FirstWanted(size_t from) const;
  Batch BatchFrom(size_t from) const;
  std::vector<BatchFrame> FramesOf(const Batch& batch) const;
  void AnnounceUpTo(size_t end);
  std::vector<size_t> TakersOf(const Batch& batch, const SelectedImage& image) const;
  PixelRect RectOf(const Batch& batch, const SelectedImage& image) const;
  void Load(const Batch& batch, Loading* loading);
  Result<void> FinishLoading(Batch* batch);
  size_t MostValues() const;
  LfPixels TakeSpare();
  void Skip(const SelectedImage& image, const Error& error);

  const LightField& light_field_;
  const LfImageStore& store_;
  std::span<const SelectedImage> order_;
  const CollectOptions options_;
  ThreadPool& pool_;
  std::vector<CollectedFrame> frames_;
  BatchCollector collector_;
  std::vector<SkippedImage> skipped_;
  CollectTimes times_;
  std::atomic<int64_t> load_cpu_ns_ = 0;
  std::atomic<int64_t> load_wall_ns_ = 0;
  size_t images_done_ = 0;
  size_t announced_ = 0;  // number of LF images of order_ that were announced to the store
  size_t most_values_ = 0;
  std::mutex spare_mutex_;
  std::vector<LfPixels> spare_;     // pixels of collected LF images; their memory is used again
  std::optional<LfImageId> whole_;  // the last LF image that was loaded without an error
  Batch batch_;                     // the batch to be collected
  Batch next_;                      // the batch to be decoded at the same time
};

Result<bool> FrameCollector::State::Step() {
  const Clock::time_point start = Clock::now();
  std::vector<BatchFrame> takers = FramesOf(batch_);
  // Skips batches that no frame needs any more, because frames may have been stopped since the
  // batch was planned.
  while (takers.empty() && !ConsumerWants(batch_.rank_end)) {
    if (batch_.end > batch_.begin) images_done_ = batch_.end;
    batch_ = next_.end > next_.begin ? std::move(next_) : BatchFrom(images_done_);
    next_ = {};
    if (batch_.begin == batch_.end) {
      spare_.clear();  // frees memory, because the caller develops frames next
      return false;
    }
    takers = FramesOf(batch_);
  }
  LF_RETURN_IF_ERROR(FinishLoading(&batch_));
  if (next_.begin == next_.end) next_ = BatchFrom(batch_.end);
  // The LF images after the next batch are announced, so that the operating system reads their
  // files while the next batch is decoded.
  const auto load_or_announce = [this](size_t i) {
    if (i > 0)
      Load(next_, &next_.loading[i - 1]);
    else
      AnnounceUpTo(BatchFrom(next_.end).end);
  };
  collector_.Add(batch_.images, takers, {1 + next_.loading.size(), load_or_announce},
                 ConsumerWants(batch_.rank_end), options_.interrupted);

  bool all_done = true;
  for (const BatchFrame& taker : takers) {
    all_done = all_done && taker.is_done;
    if (!taker.is_done) continue;
    CollectedFrame& frame = frames_[taker.frame];
    frame.progress.ranks_done = std::min(batch_.rank_end, frame.ranks.end);
    frame.progress.rays += taker.rays;
  }
  times_.load_cpu_s = static_cast<double>(load_cpu_ns_) * 1e-9;
  times_.load_wall_s = static_cast<double>(load_wall_ns_) * 1e-9;
  times_.collect_cpu_s = collector_.cpu_seconds();
  times_.wall_s += SecondsSince(start);
  if (!all_done || (takers.empty() && IsInterrupted())) return Interruption();
  if (ConsumerWants(batch_.rank_end)) options_.consumer->Take(batch_.images, batch_.rank_end);
  images_done_ = batch_.end;
  for (BatchImage& image : batch_.images) {
    image.pixels.opacity = std::move(image.opacity.radiance);
    spare_.push_back(std::move(image.pixels));
  }
  batch_ = {};
  return true;
}

// Returns the index in order_ of the first LF image, at or after index `from`, that a frame or the
// consumer still needs; order_.size() if there is none.
size_t FrameCollector::State::FirstWanted(size_t from) const {
  uint32_t rank = UINT32_MAX;
  for (const CollectedFrame& frame : frames_)
    if (Takes(frame)) rank = std::min(rank, frame.progress.ranks_done);
  if (ConsumerWants(RankEnd())) rank = std::min(rank, options_.consumer->ranks_done());
  if (rank == UINT32_MAX) return order_.size();
  const auto first = std::lower_bound(
      order_.begin(), order_.end(), rank,
      [](const SelectedImage& image, uint32_t least) { return image.rank < least; });
  return std::max(from, static_cast<size_t>(first - order_.begin()));
}

Batch FrameCollector::State::BatchFrom(size_t from) const {
  Batch batch;
  batch.begin = batch.end = FirstWanted(from);
  if (batch.begin == order_.size()) return batch;
  const uint32_t cut = options_.decision_ranks;
  const uint32_t first = order_[batch.begin].rank;
  uint32_t decision = cut == 0 ? UINT32_MAX : (first / cut + 1) * cut;
  if (options_.cuts_for_noise) decision = std::min(decision, NoiseDecisionAfter(first));
  const size_t most = batch.begin + static_cast<size_t>(options_.batch_image_count);
  uint64_t rays = 0, frame_rays = 0;
  for (; batch.end < std::min(order_.size(), most); ++batch.end) {
    const SelectedImage& image = order_[batch.end];
    rays += image.ray_count;
    frame_rays += image.ray_count / std::max(1U, image.frame_count);
    const bool is_long =
        rays > options_.batch_ray_count || frame_rays > options_.batch_frame_ray_count;
    if (image.rank >= decision || (is_long && batch.end > batch.begin)) break;
    batch.loading.push_back({.index = batch.end});
  }
  batch.rank_end =
      batch.end < order_.size() ? std::min(decision, order_[batch.end].rank) : RankEnd();
  for (const BatchFrame& taker : FramesOf(batch)) batch.frames.push_back(taker.frame);
  if (batch.frames.size() == frames_.size()) batch.frames.clear();
  return batch;
}

// Returns the frames that still take LF images and have not reached the end of the batch.
std::vector<BatchFrame> FrameCollector::State::FramesOf(const Batch& batch) const {
  std::vector<BatchFrame> takers;
  for (size_t f = 0; f < frames_.size(); ++f) {
    const CollectedFrame& frame = frames_[f];
    const uint32_t done = frame.progress.ranks_done;
    if (Takes(frame) && done < batch.rank_end)
      takers.push_back({f, {done, frame.ranks.end}, false, {}});
  }
  return takers;
}

void FrameCollector::State::AnnounceUpTo(size_t end) {
  for (; announced_ < end && !IsInterrupted(); ++announced_) store_.Announce(order_[announced_].id);
}

// Returns the frames of the batch that take an LF image.
std::vector<size_t> FrameCollector::State::TakersOf(const Batch& batch,
                                                    const SelectedImage& image) const {
  std::vector<size_t> frames;
  const auto add = [&](size_t frame) {
    if (frames_[frame].ranks.Holds(image.rank)) frames.push_back(frame);
  };
  if (batch.frames.empty())
    for (size_t frame = 0; frame < frames_.size(); ++frame) add(frame);
  else
    std::for_each(batch.frames.begin(), batch.frames.end(), add);
  return frames;
}

// Returns the bounds of the pixels of an LF image that the frames of the batch need. If
// batch.frames is empty, these are the bounds that selection has found.
PixelRect FrameCollector::State::RectOf(const Batch& batch, const SelectedImage& image) const {
  return batch.frames.empty() ? image.rect : collector_.RectOf(image.id, TakersOf(batch, image));
}

void FrameCollector::State::Load(const Batch& batch, Loading* loading) {
  if (loading->pixels || IsInterrupted()) return;
  const Clock::time_point start = Clock::now();
  const ThreadCpuTimer timer;
  const SelectedImage& selected = order_[loading->index];
  PixelRect rect = RectOf(batch, selected);
  const bool is_consumed = ConsumerWants(selected.rank + 1);
  if (is_consumed) rect = Bounds(rect, options_.consumer->RectOf(selected.id, selected.rank));
  if (!is_consumed && !rect.empty())
    loading->filtered_by = collector_.OnlyPrefilterOf(selected.id, TakersOf(batch, selected));
  // Rows that were just loaded are still in the caches, which makes filtering faster.
  std::optional<InPlaceFilter> filter;
  const auto filter_rows = [&](LfPixels* pixels, int row_count) {
    const bool is_last = row_count == pixels->radiance.height();
    if (!filter) {
      loading->opacity = pixels->TakeOpacity();
      loading->rect = pixels->rect;
      filter.emplace(*loading->filtered_by, pixels);
    }
    filter->Advance(row_count);
    if (!is_last) return;
    filter.reset();
    if (!loading->opacity.radiance.empty()) FilterInPlace(*loading->filtered_by, &loading->opacity);
  };
  loading->pixels =
      rect.empty() ? LfPixels()
                   : LoadWithoutThrowing(store_, selected.id, rect,
                                         light_field_.image_names[selected.id.value], TakeSpare(),
                                         loading->filtered_by ? RowsLoaded(filter_rows) : nullptr);
  if (*loading->pixels) {
    LfPixels& pixels = **loading->pixels;
    const bool is_guarded = !frames_.empty() && frames_.front().guard;
    if (is_guarded) {
      loading->depths = NearbyDepthsOf(pixels.depths);
      if (!is_consumed) pixels.depths = {};  // a consumer may collect guarded frames later
    }
    if (!loading->filtered_by) {
      loading->opacity = is_guarded ? TakeOpacityAndTrust(&pixels) : pixels.TakeOpacity();
      loading->rect = pixels.rect;
    }
  }
  load_cpu_ns_ += timer.Nanoseconds();
  load_wall_ns_ += std::chrono::nanoseconds(Clock::now() - start).count();
}

// Returns the number of radiances of the largest part of an LF image that selection has found.
size_t FrameCollector::State::MostValues() const {
  long long most = 0;
  for (const SelectedImage& image : order_) most = std::max(most, image.rect.pixel_count());
  const bool is_mosaic = options_.reading.estimator == Estimator::kNearest &&
                         light_field_.encoding.bayer != BayerPattern::kNone;
  return static_cast<size_t>(most) * (is_mosaic ? 1 : LfPixels::kRgbLanes);
}

// Returns pixels whose memory suffices for any LF image. Memory that grows from image to image is
// allocated several times, and its first use is slow.
LfPixels FrameCollector::State::TakeSpare() {
  const std::lock_guard lock(spare_mutex_);
  LfPixels pixels;
  if (spare_.empty()) {
    try {
      pixels.radiance.pixels().reserve(most_values_);
    } catch (const std::bad_alloc&) {
      // The store asks for less, or its error becomes that of the LF image.
    }
    return pixels;
  }
  pixels = std::move(spare_.back());
  spare_.pop_back();
  return pixels;
}

Result<void> FrameCollector::State::FinishLoading(Batch* batch) {
  if (batch->is_loaded) return {};
  AnnounceUpTo(batch->end);
  pool_.ForEach(batch->loading.size(), [&](size_t i) { Load(*batch, &batch->loading[i]); });
  for (const Loading& loading : batch->loading)
    if (!loading.pixels) return Interruption();
  for (Loading& loading : batch->loading) {
    const SelectedImage& image = order_[loading.index];
    if (*loading.pixels) {
      whole_ = image.id;
      batch->images.push_back({.id = image.id,
                               .rank = image.rank,
                               .pixels = **std::move(loading.pixels),
                               .opacity = std::move(loading.opacity),
                               .depths = std::move(loading.depths),
                               .filtered_by = loading.filtered_by,
                               .loaded = loading.rect});
      continue;
    }
    // An LF image is skipped only if it is broken itself (kInput). If the machine lacks something,
    // such as memory, the other LF images would fail for the same reason.
    const Error& error = loading.pixels->error();
    if (options_.strict || error.kind != ErrorKind::kInput) return error;
    if (whole_ && !store_.IsThere(*whole_))
      return InputError(fmt::format(
          "{}: was read before, but does not exist any more: make the folder of the LF images "
          "accessible again",
          light_field_.image_names[whole_->value]));
    Skip(image, error);
  }
  batch->loading.clear();
  batch->is_loaded = true;
  return {};
}

void FrameCollector::State::Skip(const SelectedImage& image, const Error& error) {
  // Only the first kTold skipped LF images are logged; the report of the render lists all of them.
  constexpr size_t kTold = 10;
  if (skipped_.size() < kTold) LogWarning("an LF image is left out: {}", error.message);
  if (skipped_.size() == kTold)
    LogWarning("more LF images are left out; the report at the end lists all of them");
  skipped_.push_back({light_field_.image_names[image.id.value], error.message, image.rank});
}

FrameCollector::FrameCollector(const LightField& light_field, const LfImageStore& store,
                               std::vector<CollectedFrame> frames,
                               std::span<const SelectedImage> order, const CollectOptions& options,
                               ThreadPool& pool)
    : state_(std::make_unique<State>(light_field, store, std::move(frames), order, options, pool)) {
}
FrameCollector::~FrameCollector() = default;

Result<bool> FrameCollector::Step() { return state_->Step(); }
void FrameCollector::Stop(size_t frame) { state_->frames()[frame].is_stopped = true; }
std::span<const CollectedFrame> FrameCollector::frames() const { return state_->frames(); }
std::span<const SkippedImage> FrameCollector::skipped() const { return state_->skipped(); }
size_t FrameCollector::images_done() const { return state_->images_done(); }
const CollectTimes& FrameCollector::times() const { return state_->times(); }

Result<CollectStatistics> Collect(const LightField& light_field, const LfImageStore& store,
                                  std::vector<CollectedFrame> frames,
                                  std::span<const SelectedImage> order,
                                  const CollectOptions& options, ThreadPool& pool,
                                  const std::function<void(const CollectProgress&)>& progress) {
  FrameCollector collector(light_field, store, std::move(frames), order, options, pool);
  CollectProgress done;
  while (true) {
    LF_ASSIGN_OR_RETURN(const bool stepped, collector.Step());
    if (!stepped) break;
    for (; done.image_count < collector.images_done(); ++done.image_count)
      done.tested_count += order[done.image_count].ray_count;
    if (progress) progress(done);
  }
  CollectStatistics statistics;
  for (const CollectedFrame& frame : collector.frames())
    statistics.frames.push_back(frame.progress.rays);
  statistics.skipped.assign(collector.skipped().begin(), collector.skipped().end());
  statistics.times = collector.times();
  return statistics;
}

}  // namespace lf
