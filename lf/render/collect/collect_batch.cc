// SPDX-License-Identifier: Apache-2.0
#include "lf/render/collect/collect_batch.h"

#include <algorithm>
#include <map>
#include <utility>

#include "lf/collection/gather.h"
#include "lf/collection/scatter.h"
#include "lf/render/collect/filtered_images.h"

namespace lf {
namespace {

// Decides for one frame whether the batch is collected into the frame: yes, unless *interrupted is
// true when the first thread asks. All threads get the same answer, so that the frame gets all of
// the batch or nothing.
class FrameGate {
 public:
  bool IsOpen(const std::atomic<bool>* interrupted) {
    State state = state_;
    if (state != State::kUndecided) return state == State::kOpen;
    const State decided = interrupted != nullptr && *interrupted ? State::kShut : State::kOpen;
    // If the exchange fails, `state` becomes what another thread has decided.
    if (state_.compare_exchange_strong(state, decided)) state = decided;
    return state == State::kOpen;
  }

 private:
  enum class State { kUndecided, kOpen, kShut };
  std::atomic<State> state_ = State::kUndecided;
};

// The channels of the plate that further rays of an LF image are added to. Opacities and defocus
// have the same values in R, G and B, but TakeOpacityAndTrust() puts the trust into G.
TileSums::Target OpacityTarget() { return {.channel = SensorPlate::kOpacityChannel, .count = 1}; }
TileSums::Target DefocusTarget(const SensorPlate& plate) {
  return {.channel = plate.defocus_channel(), .count = 1};
}
TileSums::Target AllRaysTarget(const SensorPlate& plate) {
  return {.channel = plate.all_rays_channel()};
}
TileSums::Target TrustTarget(const SensorPlate& plate) {
  if (plate.has_opacity()) return {.channel = plate.all_opacity_channel(), .count = 2};
  return {.channel = plate.trust_channel(), .first = 1, .count = 1};
}

void Count(uint64_t tested, uint64_t accepted, bool is_virtual, FrameRays* rays) {
  if (accepted > 0) ++(is_virtual ? rays->virtual_count : rays->image_count);
  rays->tested_count += tested;
  rays->accepted_count += accepted;
}

}  // namespace

size_t PlanBytes(Estimator estimator, bool has_distortion, int image_width, int image_height,
                 int plate_width, int plate_height, const FocalSurface* surface) {
  const bool is_nearest = estimator == Estimator::kNearest;
  // kBilinear may plan a finer plate, with at most twice the resolution of the LF image.
  const auto width =
      static_cast<size_t>(is_nearest ? image_width : std::max(plate_width, 2 * image_width));
  const auto height =
      static_cast<size_t>(is_nearest ? image_height : std::max(plate_height, 2 * image_height));
  // A scanline has a few segments; they are shorter if lens distortion bends them. The borders of
  // tiles cut a segment into two or three pieces.
  const size_t segment_width = has_distortion ? 64 : 256;
  // A piece of a focal surface has its own segments in each of its rows, as often as the plate has
  // finer rows, or LF images have more scanlines.
  const size_t of_pieces =
      surface == nullptr ? 0
                         : 2 * surface->row_count() *
                               std::max<size_t>(1, height / static_cast<size_t>(plate_height));
  return (height * (2 + width / segment_width) + of_pieces) *
         (sizeof(Segment) + (is_nearest ? 3 * sizeof(TilePiece) : 0));
}

BatchCollector::BatchCollector(const LightField& light_field,
                               std::span<const CollectedFrame> frames, const RayReading& reading,
                               CollectBackEnd back_end, size_t plan_bytes, bool whole_images,
                               ThreadPool& pool)
    : light_field_(light_field),
      frames_(frames),
      reading_(reading),
      back_end_(back_end),
      plan_bytes_(plan_bytes),
      whole_images_(whole_images),
      pool_(pool),
      filtered_(std::make_unique<FilteredImages>()) {
  for (const CollectedFrame& frame : frames_) {
    const FocalSurface* const surface = frame.camera.surface.get();
    if (surface != nullptr &&
        (largest_surface_ == nullptr || surface->row_count() > largest_surface_->row_count()))
      largest_surface_ = surface;
    tiles_.push_back(
        CutIntoTiles(frame.plate, TileSums::GridOf(frame.plate->width(), frame.plate->height())));
  }
}

BatchCollector::~BatchCollector() = default;

void BatchCollector::Add(std::vector<BatchImage>& batch, std::vector<BatchFrame>& frames,
                         const OtherItems& other_items, bool keep_pixels,
                         const std::atomic<bool>* interrupted) {
  UndoDistortion(batch);
  filtered_->Clear();
  const auto is_interrupted = [&] { return interrupted != nullptr && *interrupted; };
  if (back_end_ == CollectBackEnd::kReference || batch.empty()) {
    pool_.ForEach(other_items.count, other_items.run);
    for (BatchFrame& frame : frames)
      if (!is_interrupted()) AddByReference(batch, &frame);
    return;
  }
  const std::span<BatchFrame> takers = FramesThatMayTake(batch, frames);
  if (takers.empty()) {
    pool_.ForEach(other_items.count, other_items.run);
    return;
  }
  size_t frame_bytes = 1;
  // The plate of a frame that a stop rule has finished is empty.
  const Intrinsics& plate = frames_[0].camera.pinhole.intrinsics;
  for (const BatchImage& image : batch) {
    frame_bytes +=
        exposure_count() * PlanBytes(reading_.estimator,
                                     light_field_.Camera(image.id).intrinsics.has_distortion(),
                                     image.Pixels().rect.width(), image.Pixels().rect.height(),
                                     plate.width_px, plate.height_px, largest_surface_);
    if (is_guarded() && !light_field_.cameras[image.id.value].is_virtual)
      frame_bytes += DefocusBytes(image.Pixels().rect);
  }
  const size_t most = std::max<size_t>(1, plan_bytes_ / frame_bytes);
  for (size_t begin = 0, count = 0; begin < takers.size(); begin += count) {
    if (is_interrupted()) return;
    count = CountTogether(batch, takers.subspan(begin, std::min(takers.size() - begin, most)));
    const bool is_last = begin + count == takers.size();
    AddToFrames(batch, takers.subspan(begin, count), begin == 0 ? other_items : OtherItems{},
                keep_pixels || !is_last, interrupted);
  }
}

PixelRect BatchCollector::RectOf(const BatchImage& image, const RenderCamera& frame) const {
  if (whole_images_) return image.loaded;
  return Intersection(image.overlap->Rect(frame), image.loaded);
}

BatchCollector::Exposure BatchCollector::ExposureOf(size_t frame, size_t exposure) const {
  const CollectedFrame& of = frames_[frame];
  PixelReading reading = reading_;
  reading.correction = of.correction;
  if (exposure == 0) return {of.camera, of.weights, reading};
  if (is_guarded()) return {of.guard->camera, of.guard->weights, reading};
  const CollectedInstant& instant = of.further[exposure - 1];
  return {instant.camera, instant.weights, reading};
}

bool BatchCollector::PlainlyMisses(const BatchImage& image, size_t frame) const {
  for (size_t e = 0; e < exposure_count(); ++e)
    if (!image.overlap->PlainlyMisses(ExposureOf(frame, e).camera)) return false;
  return true;
}

// Prepares cells, ideal pixels and overlap of the LF images. LF images with the same intrinsics
// share their ideal pixels, also with the next batch. Only the fast back end of kNearest needs
// ideal pixels, because no other code follows the arcs into which distortion bends scanlines.
void BatchCollector::UndoDistortion(std::vector<BatchImage>& batch) {
  if (reading_.estimator == Estimator::kNearest && back_end_ == CollectBackEnd::kFast)
    ideal_pixels_.Keep(light_field_, batch,
                       [&](size_t count, const auto& body) { ForEachTimed(count, body); });
  std::map<uint32_t, std::shared_ptr<const std::vector<IdealCell>>> cells;
  for (BatchImage& image : batch) {
    const uint32_t index = light_field_.cameras[image.id.value].intrinsics_index;
    std::shared_ptr<const std::vector<IdealCell>>& shared = cells[index];
    if (!shared)
      shared = std::make_shared<const std::vector<IdealCell>>(
          light_field_.intrinsics[index].has_distortion()
              ? MakeIdealCells(light_field_.intrinsics[index])
              : std::vector<IdealCell>());
    if (!image.filtered_by) image.loaded = image.Pixels().rect;
    image.cells = shared;
    image.ideal_pixels = ideal_pixels_.Of(index);
    image.overlap.emplace(light_field_.Camera(image.id), *image.cells, ReachOf(reading_));
  }
}

// Returns the frames that may get rays of the batch. If a long camera path leads through a large
// light field, these are few. The other frames are marked as done and moved to the end of `frames`.
std::span<BatchFrame> BatchCollector::FramesThatMayTake(const std::vector<BatchImage>& batch,
                                                        std::span<BatchFrame> frames) {
  ForEachTimed(frames.size(), [&](size_t f) {
    frames[f].is_done = std::none_of(batch.begin(), batch.end(), [&](const BatchImage& image) {
      return frames[f].ranks.Holds(image.rank) &&
             (whole_images_ || !PlainlyMisses(image, frames[f].frame));
    });
  });
  const auto rest = std::stable_partition(frames.begin(), frames.end(),
                                          [](const BatchFrame& frame) { return !frame.is_done; });
  return frames.first(static_cast<size_t>(rest - frames.begin()));
}

// Plans the segments (pieces of scanlines) of an LF image in an exposure. Leaves the rectangle of
// the contribution empty if there are none.
void BatchCollector::PlanContribution(const BatchImage& image, const Exposure& exposure,
                                      Contribution* contribution) const {
  const RenderCamera& frame = exposure.camera;
  const PinholeCamera camera = light_field_.Camera(image.id);
  contribution->weights = WeightsOf(exposure, image.id);
  if (contribution->weights.are_none()) return;
  contribution->rect = RectOf(image, frame);
  if (contribution->rect.empty()) return;
  const Intrinsics& plate = frame.pinhole.intrinsics;
  if (reading_.estimator == Estimator::kBilinear)
    contribution->gather =
        PlanGather(camera, frame, std::move(contribution->gather), exposure.reading);
  else
    contribution->scatter = PlanScatter(camera, frame, contribution->rect,
                                        TileSums::GridOf(plate.width_px, plate.height_px),
                                        image.ideal_pixels.get(), std::move(contribution->scatter));
}

void BatchCollector::AddToFrames(std::vector<BatchImage>& batch, std::span<BatchFrame> frames,
                                 const OtherItems& other_items, bool keep_pixels,
                                 const std::atomic<bool>* interrupted) {
  // First plans all contributions, then adds the rays of every pair of frame and tile.
  const size_t of_frame = exposure_count() * batch.size();
  while (contributions_.size() < frames.size() * of_frame) contributions_.emplace_back();
  ForEachTimed(frames.size() * of_frame, [&](size_t i) {
    const BatchFrame& taker = frames[i / of_frame];
    const size_t exposure = i % of_frame / batch.size();
    const BatchImage& image = batch[i % batch.size()];
    Contribution& contribution = contributions_[i];
    contribution.rect = {};
    contribution.accepted_count = 0;
    if (!taker.ranks.Holds(image.rank)) return;
    PlanContribution(image, ExposureOf(taker.frame, exposure), &contribution);
    if (!is_guarded() || exposure > 0 || contribution.rect.empty()) return;
    contribution.defocus = DefocusIn(taker.frame, image, TakeSpareDefocus());
    if (const Prefilter filter = PrefilterOf(contribution); !filter.changes_nothing())
      FilterInPlace(filter, &contribution.defocus);
  });

  FilterImages(batch, frames.size(), keep_pixels);

  struct Task {
    size_t taker;
    size_t tile;
  };
  std::vector<Task> tasks;
  for (size_t f = 0; f < frames.size(); ++f)
    for (size_t tile = 0; tile < tiles_[frames[f].frame].size(); ++tile) tasks.push_back({f, tile});
  std::vector<FrameGate> gates(frames.size());
  // Items of `other_items` take longer than tiles, and therefore come first: if the last items are
  // short, threads wait only briefly at the end.
  pool_.ForEach(other_items.count + tasks.size(), [&](size_t i) {
    if (i < other_items.count) {
      other_items.run(i);
      return;
    }
    const ThreadCpuTimer timer;
    const Task& task = tasks[i - other_items.count];
    if (gates[task.taker].IsOpen(interrupted))
      CollectTile(batch, task.taker, frames[task.taker].frame, task.tile);
    cpu_ns_ += timer.Nanoseconds();
  });

  // The memory goes to other LF images, because the next batch has its recorded ones at other
  // indices.
  for (Contribution& contribution : contributions_)
    if (!contribution.defocus.radiance.empty())
      spare_defocus_.push_back(std::exchange(contribution.defocus, {}));
  for (size_t f = 0; f < frames.size(); ++f) {
    frames[f].is_done = gates[f].IsOpen(nullptr);
    if (!frames[f].is_done) continue;
    for (size_t k = 0; k < batch.size(); ++k) {
      uint64_t tested = 0, accepted = 0;
      for (size_t e = 0; e < instant_count(); ++e) {
        const Contribution& contribution = ContributionOf(f, e, k, batch.size());
        tested += static_cast<uint64_t>(contribution.rect.pixel_count());
        accepted += contribution.accepted_count;
      }
      Count(tested, accepted, IsVirtual(batch[k].id), &frames[f].rays);
      if (is_guarded() && IsVirtual(batch[k].id) &&
          ContributionOf(f, 1, k, batch.size()).accepted_count > 0)
        ++frames[f].rays.virtual_count;
    }
  }
}

LfPixels BatchCollector::TakeSpareDefocus() {
  const std::lock_guard lock(defocus_mutex_);
  if (spare_defocus_.empty()) return {};
  LfPixels pixels = std::move(spare_defocus_.back());
  spare_defocus_.pop_back();
  return pixels;
}

// Adds the planned rays of all LF images of the batch to a tile of a frame.
//   taker  index of the frame among those that are planned together
void BatchCollector::CollectTile(std::span<const BatchImage> batch, size_t taker, size_t frame,
                                 size_t number) {
  thread_local TileSums sums;
  PlateTile& tile = tiles_[frame][number];
  // Calls body() for the exposures [begin, end) of LF image k.
  const auto for_each = [&](size_t k, size_t begin, size_t end, const auto& body) {
    for (size_t e = begin; e < end; ++e)
      if (Contribution& contribution = ContributionOf(taker, e, k, batch.size());
          !contribution.rect.empty())
        body(contribution);
  };
  NoiseTally tally(frames_[frame].moments, tile.rect());
  sums.Begin(&tile, tally.elements());
  for (size_t k = 0; k < batch.size(); ++k) {
    uint64_t of_image = 0;  // rays at all instants
    for_each(k, 0, instant_count(), [&](Contribution& contribution) {
      const uint64_t accepted = AddToTile(contribution, number, *contribution.pixels, &sums);
      contribution.accepted_count += accepted;
      of_image += accepted;
    });
    if (of_image > 0)
      tally.TakeImage(IsVirtual(batch[k].id),
                      [&](size_t element, int c) { return sums.Added(element, c); });
  }
  sums.Flush();
  // Adds the rays of the exposures [begin, end) to further channels.
  const auto add = [&](const TileSums::Target& target, size_t begin, size_t end, const auto& body) {
    sums.Begin(&tile, {}, target);
    for (size_t k = 0; k < batch.size(); ++k) for_each(k, begin, end, body);
    sums.Flush();
  };
  const auto add_opacity = [&](const Contribution& contribution) {
    AddToTile(contribution, number, *contribution.opacity, &sums);
  };
  const SensorPlate& plate = *frames_[frame].plate;
  if (plate.has_opacity()) add(OpacityTarget(), 0, instant_count(), add_opacity);
  if (!is_guarded()) return;
  add(DefocusTarget(plate), 0, 1, [&](const Contribution& contribution) {
    AddToTile(contribution, number, contribution.defocus, &sums);
  });
  add(AllRaysTarget(plate), 1, 2, [&](Contribution& contribution) {
    contribution.accepted_count += AddToTile(contribution, number, *contribution.pixels, &sums);
  });
  add(TrustTarget(plate), 1, 2, add_opacity);
}

// Filters the LF images of the batch for the planned contributions to `frame_count` frames, and
// sets the pixels and the opacities of these contributions.
void BatchCollector::FilterImages(std::vector<BatchImage>& batch, size_t frame_count,
                                  bool keep_pixels) {
  std::vector<std::vector<Prefilter>> filters(batch.size());
  const auto for_each_planned = [&](const auto& body) {
    for (size_t i = 0; i < frame_count * exposure_count() * batch.size(); ++i)
      if (!contributions_[i].rect.empty()) body(i % batch.size(), contributions_[i]);
  };
  for_each_planned([&](size_t k, const Contribution& contribution) {
    filters[k].push_back(PrefilterOf(contribution));
  });
  filtered_->Filter(batch, std::move(filters), keep_pixels,
                    [&](size_t count, const auto& body) { ForEachTimed(count, body); });
  for_each_planned([&](size_t k, Contribution& contribution) {
    contribution.pixels = &filtered_->Pixels(batch, k, PrefilterOf(contribution));
    contribution.opacity = &filtered_->Opacity(batch, k, PrefilterOf(contribution));
  });
}

// Adds the rays of one LF image that land in a tile to `sums`. Returns the number of these rays.
uint64_t BatchCollector::AddToTile(const Contribution& contribution, size_t tile,
                                   const LfPixels& pixels, TileSums* sums) const {
  return reading_.estimator == Estimator::kBilinear
             ? GatherTile(contribution.gather, pixels, sums, contribution.weights)
             : ScatterTile(contribution.scatter, tile, pixels, sums, contribution.weights);
}

void BatchCollector::AddByReference(const std::vector<BatchImage>& batch, BatchFrame* frame) {
  const ThreadCpuTimer timer;
  SensorPlate& plate = *frames_[frame->frame].plate;
  NoiseTally tally(frames_[frame->frame].moments, {0, 0, plate.width(), plate.height()});
  const auto total_of = [&](size_t element, int c) {
    return plate.At(tally.elements()[element].x, tally.elements()[element].y, c);
  };
  tally.Start(total_of);
  for (const BatchImage& image : batch) {
    if (!frame->ranks.Holds(image.rank)) continue;
    if (is_guarded()) {
      const Exposure all = ExposureOf(frame->frame, 1);
      if (AddChannelsByReference(image, image.Pixels(), all, AllRaysTarget(plate), &plate) > 0)
        frame->rays.virtual_count += IsVirtual(image.id) ? 1 : 0;
      AddChannelsByReference(image, image.Opacity(), all, TrustTarget(plate), &plate);
    }
    uint64_t tested = 0, accepted = 0;
    for (size_t e = 0; e < instant_count(); ++e) {
      const Exposure exposure = ExposureOf(frame->frame, e);
      const PixelRect rect = RectOf(image, exposure.camera);
      if (rect.empty() || WeightsOf(exposure, image.id).are_none()) continue;
      tested += static_cast<uint64_t>(rect.pixel_count());
      accepted += CollectByReference(image, image.Pixels(), exposure, &plate);
      if (plate.has_opacity())
        AddChannelsByReference(image, image.Opacity(), exposure, OpacityTarget(), &plate);
      if (is_guarded())
        AddChannelsByReference(image, DefocusIn(frame->frame, image, {}), exposure,
                               DefocusTarget(plate), &plate);
    }
    tally.TakeImage(IsVirtual(image.id), total_of);
    Count(tested, accepted, IsVirtual(image.id), &frame->rays);
  }
  frame->is_done = true;
  cpu_ns_ += timer.Nanoseconds();
}

uint64_t BatchCollector::CollectByReference(const BatchImage& image, const LfPixels& pixels,
                                            const Exposure& exposure, SensorPlate* plate) const {
  const PixelRect rect = RectOf(image, exposure.camera);
  const RayWeights weights = WeightsOf(exposure, image.id);
  if (rect.empty() || weights.are_none()) return 0;
  const PinholeCamera lf_camera = light_field_.Camera(image.id);
  return reading_.estimator == Estimator::kBilinear
             ? GatherReference(lf_camera, pixels, exposure.camera, plate, weights, exposure.reading)
             : ScatterReference(lf_camera, pixels, exposure.camera, rect, plate, weights);
}

// Collects the pixels on a separate plate, and adds channels of that plate to `plate` as `target`
// says. Returns the number of rays.
uint64_t BatchCollector::AddChannelsByReference(const BatchImage& image, const LfPixels& pixels,
                                                const Exposure& exposure,
                                                const TileSums::Target& target,
                                                SensorPlate* plate) const {
  SensorPlate separate(plate->width(), plate->height());
  const uint64_t accepted = CollectByReference(image, pixels, exposure, &separate);
  for (int y = 0; y < plate->height(); ++y)
    for (int x = 0; x < plate->width(); ++x)
      for (int i = 0; i < target.count; ++i)
        plate->Add(x, y, target.channel + i, separate.At(x, y, target.first + i));
  return accepted;
}

LfPixels BatchCollector::DefocusIn(size_t frame, const BatchImage& image, LfPixels memory) const {
  const CollectedFrame& of = frames_[frame];
  const PinholeCamera lf_camera = light_field_.Camera(image.id);
  const double unit_px = DefocusUnitPx(image.depths.depths.divisor, lf_camera.intrinsics,
                                       of.camera.pinhole.intrinsics);
  return DefocusOf(image.depths, lf_camera, of.camera.focus_plane, of.guard->camera_distance_w,
                   unit_px, image.loaded, std::move(memory));
}

// Runs body(i) for each item i in [0, count), and measures the CPU time. If there are many items,
// several are run as one task, because reading the clock takes longer than an item whose LF image
// misses the frame.
void BatchCollector::ForEachTimed(size_t count, const std::function<void(size_t)>& body) {
  constexpr size_t kTasksPerThread = 64, kMostItems = 32;
  const size_t tasks_wanted = kTasksPerThread * static_cast<size_t>(pool_.thread_count());
  const size_t together = std::clamp<size_t>(count / tasks_wanted, 1, kMostItems);
  pool_.ForEach((count + together - 1) / together, [&](size_t task) {
    const ThreadCpuTimer timer;
    for (size_t i = task * together; i < std::min(count, (task + 1) * together); ++i) body(i);
    cpu_ns_ += timer.Nanoseconds();
  });
}

}  // namespace lf
