#include "lf/pipeline/collect.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <new>
#include <optional>
#include <utility>

#include "lf/core/log.h"
#include "lf/selection/overlap.h"

namespace lf {
namespace {

using Clock = std::chrono::steady_clock;

double SecondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// An exception that leaves a task would end the program.
Result<LfPixels> LoadWithoutThrowing(const LfImageStore& store, LfImageId id, const PixelRect& rect,
                                     const std::string& name) {
  try {
    return store.Load(id, rect);
  } catch (const std::bad_alloc&) {
    return OutputError(
        fmt::format("{}: no memory to load it: lower --memory, or give the machine more", name));
  } catch (const std::exception& exception) {
    return InputError(fmt::format("{}: {}", name, exception.what()));
  }
}

// An LF image of a batch while it is decoded.
struct Loading {
  size_t place = 0;
  std::optional<Result<LfPixels>> pixels;
};

// Places [begin, end) of the order.
struct Batch {
  size_t begin = 0;
  size_t end = 0;
  std::vector<size_t> frames;  // that take it, if these are not all
  std::vector<Loading> loading;
  std::vector<BatchImage> images;  // those that are whole, when all are loaded
  bool is_loaded = false;
};

}  // namespace

class FrameCollector::State {
 public:
  State(const LightField& light_field, const LfImageStore& store,
        std::span<const RenderCamera> frames, std::span<const SelectedImage> order,
        std::span<const FrameProgress> start, const CollectOptions& options, ThreadPool& pool,
        std::vector<SensorPlate>* plates)
      : light_field_(light_field),
        store_(store),
        order_(order),
        options_(options),
        pool_(pool),
        collector_(light_field, frames, options.estimator, options.back_end, pool, plates),
        progress_(start.begin(), start.end()),
        is_stopped_(start.size(), false) {
    LF_CHECK(start.size() == frames.size());
    LF_CHECK(options.batch_image_count >= 1);
    place_ = announced_ = FirstPlaceWanted(0);
  }

  Result<bool> Step();

  std::vector<FrameProgress>& progress() { return progress_; }
  std::vector<bool>& is_stopped() { return is_stopped_; }
  const std::vector<SkippedImage>& skipped() const { return skipped_; }
  const CollectTimes& times() const { return times_; }
  size_t place() const { return place_; }

 private:
  bool IsInterrupted() const { return options_.interrupted != nullptr && *options_.interrupted; }
  Error Interruption() const {
    return {ErrorKind::kInterrupted,
            fmt::format("interrupted after {} of {} LF images", place_, order_.size())};
  }
  size_t FirstPlaceWanted(size_t from) const;
  Batch BatchFrom(size_t from) const;
  std::vector<BatchFrame> FramesOf(const Batch& batch) const;
  void AnnounceUpTo(size_t end);
  void Load(const Batch& batch, Loading* loading);
  Result<void> FinishLoading(Batch* batch);
  void Skip(size_t place, const Error& error);

  const LightField& light_field_;
  const LfImageStore& store_;
  std::span<const SelectedImage> order_;
  const CollectOptions options_;
  ThreadPool& pool_;
  BatchCollector collector_;
  std::vector<FrameProgress> progress_;
  std::vector<bool> is_stopped_;
  std::vector<SkippedImage> skipped_;
  CollectTimes times_;
  std::atomic<int64_t> load_cpu_ns_ = 0;
  std::atomic<int64_t> load_wall_ns_ = 0;
  size_t place_ = 0;
  size_t announced_ = 0;  // places before are known to the store
  Batch batch_;           // the one to be collected
  Batch next_;            // the one to be decoded meanwhile
};

Result<bool> FrameCollector::State::Step() {
  const Clock::time_point start = Clock::now();
  std::vector<BatchFrame> takers = FramesOf(batch_);
  // Frames may have been stopped since the next batch was planned.
  while (takers.empty()) {
    if (batch_.end > batch_.begin) place_ = batch_.end;
    batch_ = next_.end > next_.begin ? std::move(next_) : BatchFrom(place_);
    next_ = {};
    if (batch_.begin == batch_.end) return false;
    takers = FramesOf(batch_);
  }
  LF_RETURN_IF_ERROR(FinishLoading(&batch_));
  if (next_.begin == next_.end) next_ = BatchFrom(batch_.end);
  // Files are read by the system while the images before them are decoded.
  const auto load_or_announce = [this](size_t i) {
    if (i > 0)
      Load(next_, &next_.loading[i - 1]);
    else
      AnnounceUpTo(BatchFrom(next_.end).end);
  };
  collector_.Add(batch_.images, takers, {1 + next_.loading.size(), load_or_announce},
                 options_.interrupted);

  bool all_done = true;
  for (const BatchFrame& taker : takers) {
    all_done = all_done && taker.is_done;
    if (!taker.is_done) continue;
    FrameProgress& progress = progress_[taker.frame];
    progress.places_done = batch_.end;
    progress.rays.image_count += taker.rays.image_count;
    progress.rays.tested_count += taker.rays.tested_count;
    progress.rays.accepted_count += taker.rays.accepted_count;
  }
  times_.load_cpu_s = static_cast<double>(load_cpu_ns_) * 1e-9;
  times_.load_wall_s = static_cast<double>(load_wall_ns_) * 1e-9;
  times_.collect_cpu_s = collector_.cpu_seconds();
  times_.wall_s += SecondsSince(start);
  if (!all_done) return Interruption();
  place_ = batch_.end;
  batch_ = {};
  return true;
}

// The first place from `from` on that a frame has still to take.
size_t FrameCollector::State::FirstPlaceWanted(size_t from) const {
  size_t first = order_.size();
  for (size_t f = 0; f < progress_.size(); ++f)
    if (!is_stopped_[f]) first = std::min(first, progress_[f].places_done);
  return std::max(first, std::min(from, order_.size()));
}

Batch FrameCollector::State::BatchFrom(size_t from) const {
  Batch batch;
  batch.begin = FirstPlaceWanted(from);
  const size_t decision = (batch.begin / kDecisionPlaces + 1) * kDecisionPlaces;
  const size_t count = static_cast<size_t>(options_.batch_image_count);
  batch.end = std::min({order_.size(), decision, batch.begin + count});
  for (size_t place = batch.begin; place < batch.end; ++place)
    batch.loading.push_back({place, std::nullopt});
  for (const BatchFrame& taker : FramesOf(batch)) batch.frames.push_back(taker.frame);
  if (batch.frames.size() == progress_.size()) batch.frames.clear();
  return batch;
}

// Those behind the end of the batch.
std::vector<BatchFrame> FrameCollector::State::FramesOf(const Batch& batch) const {
  std::vector<BatchFrame> frames;
  for (size_t f = 0; f < progress_.size(); ++f)
    if (!is_stopped_[f] && progress_[f].places_done < batch.end)
      frames.push_back({f, progress_[f].places_done, false, {}});
  return frames;
}

void FrameCollector::State::AnnounceUpTo(size_t end) {
  for (; announced_ < end && !IsInterrupted(); ++announced_) store_.Announce(order_[announced_].id);
}

void FrameCollector::State::Load(const Batch& batch, Loading* loading) {
  if (loading->pixels || IsInterrupted()) return;
  const Clock::time_point start = Clock::now();
  const ThreadCpuTimer timer;
  const SelectedImage& selected = order_[loading->place];
  // Those of all frames where all take it.
  const PixelRect rect =
      batch.frames.empty() ? selected.rect : collector_.RectOf(selected.id, batch.frames);
  loading->pixels = rect.empty() ? LfPixels()
                                 : LoadWithoutThrowing(store_, selected.id, rect,
                                                       light_field_.image_names[selected.id.value]);
  load_cpu_ns_ += timer.Nanoseconds();
  load_wall_ns_ += std::chrono::nanoseconds(Clock::now() - start).count();
}

Result<void> FrameCollector::State::FinishLoading(Batch* batch) {
  if (batch->is_loaded) return {};
  AnnounceUpTo(batch->end);
  pool_.ForEach(batch->loading.size(), [&](size_t i) { Load(*batch, &batch->loading[i]); });
  for (const Loading& loading : batch->loading)
    if (!loading.pixels) return Interruption();
  for (Loading& loading : batch->loading) {
    if (*loading.pixels) {
      const LfImageId id = order_[loading.place].id;
      batch->images.push_back({loading.place, id, **std::move(loading.pixels), {}, nullptr});
      continue;
    }
    // Only the image itself may be at fault: what the machine lacks is no reason to go on.
    const Error& error = loading.pixels->error();
    if (options_.strict || error.kind != ErrorKind::kInput) return error;
    Skip(loading.place, error);
  }
  batch->loading.clear();
  batch->is_loaded = true;
  return {};
}

void FrameCollector::State::Skip(size_t place, const Error& error) {
  // The first are told at once; a report has them all.
  constexpr size_t kTold = 10;
  if (skipped_.size() < kTold) LogWarning("LF image skipped: {}", error.message);
  if (skipped_.size() == kTold)
    LogWarning("more LF images are broken; they are counted and reported at the end");
  skipped_.push_back({light_field_.image_names[order_[place].id.value], error.message, place});
}

FrameCollector::FrameCollector(const LightField& light_field, const LfImageStore& store,
                               std::span<const RenderCamera> frames,
                               std::span<const SelectedImage> order,
                               std::span<const FrameProgress> start, const CollectOptions& options,
                               ThreadPool& pool, std::vector<SensorPlate>* plates)
    : state_(std::make_unique<State>(light_field, store, frames, order, start, options, pool,
                                     plates)) {}
FrameCollector::~FrameCollector() = default;

Result<bool> FrameCollector::Step() { return state_->Step(); }
void FrameCollector::Stop(size_t frame) { state_->is_stopped()[frame] = true; }
std::span<const FrameProgress> FrameCollector::frames() const { return state_->progress(); }
std::span<const SkippedImage> FrameCollector::skipped() const { return state_->skipped(); }
size_t FrameCollector::place() const { return state_->place(); }
const CollectTimes& FrameCollector::times() const { return state_->times(); }

Result<CollectStatistics> Collect(const LightField& light_field, const LfImageStore& store,
                                  std::span<const RenderCamera> frames,
                                  std::span<const SelectedImage> order,
                                  const CollectOptions& options, ThreadPool& pool,
                                  std::vector<SensorPlate>* plates,
                                  const std::function<void(const CollectProgress&)>& progress) {
  const std::vector<FrameProgress> start(frames.size());
  FrameCollector collector(light_field, store, frames, order, start, options, pool, plates);
  CollectProgress done;
  while (true) {
    LF_ASSIGN_OR_RETURN(const bool stepped, collector.Step());
    if (!stepped) break;
    for (; done.image_count < collector.place(); ++done.image_count)
      done.tested_count += order[done.image_count].ray_count;
    if (progress) progress(done);
  }
  CollectStatistics statistics;
  for (const FrameProgress& frame : collector.frames()) statistics.frames.push_back(frame.rays);
  statistics.skipped.assign(collector.skipped().begin(), collector.skipped().end());
  statistics.times = collector.times();
  return statistics;
}

}  // namespace lf
