#include "lf/pipeline/collect.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <map>
#include <memory>
#include <optional>

#include "lf/camera/ideal_pixels.h"
#include "lf/collection/gather.h"
#include "lf/collection/scatter.h"
#include "lf/core/log.h"
#include "lf/selection/overlap.h"
#include "lf/store/prefetch.h"

namespace lf {
namespace {

// A band of this size stays in the second level cache while a batch of LF images is added to it.
constexpr size_t kBandBytes = size_t{512} << 10;
constexpr int kLeastBandRows = 8;

// Spans of a batch kept at the same time.
constexpr size_t kPlanBytes = size_t{64} << 20;

class Stopwatch {
 public:
  double Seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

struct BatchImage {
  LfImageId id;
  LfPixels pixels;
  // Of a camera with lens distortion.
  std::vector<IdealCell> cells;
  std::shared_ptr<const IdealPixels> ideal_pixels;
};

std::vector<PlateBand> CutIntoBands(SensorPlate* plate) {
  const size_t row_bytes =
      static_cast<size_t>(plate->width()) * SensorPlate::kChannels * sizeof(uint64_t);
  const int rows = std::max(kLeastBandRows, static_cast<int>(kBandBytes / row_bytes));
  std::vector<PlateBand> bands;
  for (int y = 0; y < plate->height(); y += rows)
    bands.emplace_back(plate, y, std::min(plate->height(), y + rows));
  return bands;
}

class Collector {
 public:
  Collector(const LightField& light_field, std::span<const RenderCamera> frames,
            Estimator estimator, CollectBackEnd back_end, ThreadPool& pool,
            std::vector<SensorPlate>* plates)
      : light_field_(light_field),
        frames_(frames),
        estimator_(estimator),
        back_end_(back_end),
        pool_(pool),
        plates_(*plates),
        rays_(frames.size()) {
    LF_CHECK(plates->size() == frames.size());
    for (SensorPlate& plate : plates_) bands_.push_back(CutIntoBands(&plate));
  }

  void Add(std::vector<BatchImage>& batch) {
    UndoDistortion(batch);
    if (back_end_ == CollectBackEnd::kReference) {
      AddByReference(batch);
      return;
    }
    int tallest = 1;
    for (const BatchImage& image : batch) tallest = std::max(tallest, image.pixels.rect.height());
    const size_t plan_bytes = batch.size() * static_cast<size_t>(tallest) * sizeof(RaySpan);
    const size_t chunk = std::max<size_t>(1, kPlanBytes / std::max<size_t>(1, plan_bytes));
    for (size_t begin = 0; begin < frames_.size(); begin += chunk)
      AddToFrames(batch, begin, std::min(frames_.size(), begin + chunk));
  }

  std::vector<FrameRays> TakeRays() { return std::move(rays_); }

 private:
  struct Share {
    PixelRect rect;
    ScatterPlan scatter;  // of the estimator in use
    std::optional<GatherPlan> gather;
    std::atomic<uint64_t> accepted_count = 0;
  };

  PixelRect RectOf(const BatchImage& image, const RenderCamera& frame) const {
    return Intersection(
        ContributingRect(light_field_.Camera(image.id), frame, image.cells, ReachOf(estimator_)),
        image.pixels.rect);
  }

  // Images of one camera share its ideal pixels, also with the next batch. Only the fast back end
  // of nearest follows arcs.
  void UndoDistortion(std::vector<BatchImage>& batch) {
    const bool needs_arcs = estimator_ == Estimator::kNearest && back_end_ == CollectBackEnd::kFast;
    std::map<uint32_t, std::shared_ptr<const IdealPixels>> in_use;
    std::vector<uint32_t> missing;
    for (const BatchImage& image : batch) {
      const uint32_t index = light_field_.cameras[image.id.value].intrinsics_index;
      if (!light_field_.intrinsics[index].has_distortion() || in_use.contains(index)) continue;
      const auto known = ideal_pixels_.find(index);
      if (needs_arcs && known == ideal_pixels_.end()) missing.push_back(index);
      in_use[index] = known == ideal_pixels_.end() ? nullptr : known->second;
    }
    pool_.ForEach(missing.size(), [&](size_t i) {
      in_use.find(missing[i])->second =
          std::make_shared<const IdealPixels>(light_field_.intrinsics[missing[i]]);
    });
    for (BatchImage& image : batch) {
      const uint32_t index = light_field_.cameras[image.id.value].intrinsics_index;
      const auto found = in_use.find(index);
      if (found == in_use.end()) continue;
      image.ideal_pixels = found->second;
      image.cells = MakeIdealCells(light_field_.intrinsics[index]);
    }
    ideal_pixels_ = std::move(in_use);
  }

  void AddToFrames(const std::vector<BatchImage>& batch, size_t frame_begin, size_t frame_end) {
    const size_t frame_count = frame_end - frame_begin;
    // First the spans of every (frame, image), then the rays of every (frame, band).
    std::vector<Share> shares(frame_count * batch.size());
    pool_.ForEach(shares.size(), [&](size_t i) {
      const RenderCamera& frame = frames_[frame_begin + i / batch.size()];
      const BatchImage& image = batch[i % batch.size()];
      const PinholeCamera camera = light_field_.Camera(image.id);
      shares[i].rect = RectOf(image, frame);
      if (shares[i].rect.empty()) return;
      if (estimator_ == Estimator::kBilinear)
        shares[i].gather.emplace(camera, frame);
      else
        shares[i].scatter = PlanScatter(camera, frame, shares[i].rect, image.ideal_pixels.get());
    });

    struct Task {
      size_t frame;
      size_t band;
      uint64_t accepted_count = 0;
    };
    std::vector<Task> tasks;
    for (size_t f = 0; f < frame_count; ++f)
      for (size_t band = 0; band < bands_[frame_begin + f].size(); ++band)
        tasks.push_back({f, band});
    pool_.ForEach(tasks.size(), [&](size_t i) {
      Task& task = tasks[i];
      for (size_t k = 0; k < batch.size(); ++k) {
        Share& share = shares[task.frame * batch.size() + k];
        if (share.rect.empty()) continue;
        PlateBand& band = bands_[frame_begin + task.frame][task.band];
        const uint64_t accepted = share.gather ? share.gather->GatherBand(batch[k].pixels, &band)
                                               : ScatterBand(share.scatter, batch[k].pixels, &band);
        task.accepted_count += accepted;
        share.accepted_count += accepted;
      }
    });

    for (const Task& task : tasks)
      rays_[frame_begin + task.frame].accepted_count += task.accepted_count;
    for (size_t i = 0; i < shares.size(); ++i)
      Count(frame_begin + i / batch.size(), shares[i].rect, shares[i].accepted_count > 0);
  }

  void AddByReference(const std::vector<BatchImage>& batch) {
    for (size_t f = 0; f < frames_.size(); ++f)
      for (const BatchImage& image : batch) {
        const PinholeCamera camera = light_field_.Camera(image.id);
        const PixelRect rect = RectOf(image, frames_[f]);
        if (rect.empty()) continue;
        const uint64_t accepted =
            estimator_ == Estimator::kBilinear
                ? GatherReference(camera, image.pixels, frames_[f], &plates_[f])
                : ScatterReference(camera, image.pixels, frames_[f], rect, &plates_[f]);
        rays_[f].accepted_count += accepted;
        Count(f, rect, accepted > 0);
      }
  }

  void Count(size_t frame, const PixelRect& rect, bool any_accepted) {
    rays_[frame].image_count += any_accepted ? 1 : 0;
    rays_[frame].tested_count += static_cast<uint64_t>(rect.pixel_count());
  }

  const LightField& light_field_;
  std::span<const RenderCamera> frames_;
  Estimator estimator_;
  CollectBackEnd back_end_;
  ThreadPool& pool_;
  std::vector<SensorPlate>& plates_;
  std::vector<std::vector<PlateBand>> bands_;
  std::vector<FrameRays> rays_;
  // By index of intrinsics; those of the last batch.
  std::map<uint32_t, std::shared_ptr<const IdealPixels>> ideal_pixels_;
};

void Skip(const std::string& name, const Error& error, CollectStatistics* statistics) {
  // The first are told at once; a report has them all.
  constexpr size_t kTold = 10;
  if (statistics->skipped.size() < kTold) LogWarning("LF image skipped: {}", error.message);
  if (statistics->skipped.size() == kTold)
    LogWarning("more LF images are broken; they are counted and reported at the end");
  statistics->skipped.push_back({name, error.message});
}

}  // namespace

const char* NameOf(Estimator estimator) {
  return estimator == Estimator::kBilinear ? "bilinear" : "nearest";
}

PixelReach ReachOf(Estimator estimator) {
  return estimator == Estimator::kBilinear ? PixelReach::kNeighbours : PixelReach::kOwn;
}

Result<CollectStatistics> Collect(const LightField& light_field, const LfImageStore& store,
                                  std::span<const RenderCamera> frames,
                                  std::span<const SelectedImage> images,
                                  const CollectOptions& options, ThreadPool& pool,
                                  std::vector<SensorPlate>* plates,
                                  const std::function<void(const CollectProgress&)>& progress) {
  std::vector<LoadRequest> requests;
  for (const SelectedImage& image : images) requests.push_back({image.id, image.rect});
  Prefetcher prefetcher(store, std::move(requests),
                        {options.loader_count, options.queue_bytes, options.image_bytes});

  Collector collector(light_field, frames, options.estimator, options.back_end, pool, plates);
  CollectStatistics statistics;
  CollectProgress done;
  std::vector<BatchImage> batch;
  while (done.image_count < images.size()) {
    const size_t first = done.image_count;
    const size_t end =
        std::min(images.size(), first + static_cast<size_t>(options.batch_image_count));
    for (; done.image_count < end; ++done.image_count) {
      if (options.interrupted != nullptr && *options.interrupted)
        return Error{ErrorKind::kInterrupted,
                     fmt::format("interrupted after {} of {} LF images", first, images.size())};
      const SelectedImage& selected = images[done.image_count];
      done.tested_count += selected.ray_count;
      std::optional<LoadedImage> loaded = prefetcher.Next();
      LF_CHECK(loaded && loaded->id == selected.id);
      if (loaded->pixels) {
        batch.push_back({selected.id, *std::move(loaded->pixels), {}, nullptr});
        continue;
      }
      // Only the image itself may be at fault: what the machine lacks is no reason to go on.
      const Error& error = loaded->pixels.error();
      if (options.strict || error.kind != ErrorKind::kInput) return error;
      Skip(light_field.image_names[selected.id.value], error, &statistics);
    }
    const Stopwatch stopwatch;
    if (!batch.empty()) collector.Add(batch);
    batch.clear();
    statistics.collect_wall_s += stopwatch.Seconds();
    if (progress) progress(done);
  }
  statistics.frames = collector.TakeRays();
  statistics.load_cpu_s = prefetcher.load_seconds();
  return statistics;
}

}  // namespace lf
