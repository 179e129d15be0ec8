// SPDX-License-Identifier: Apache-2.0
#include "lf/render/needs/frame_needs.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <span>
#include <utility>

#include "lf/core/check.h"
#include "lf/render/collect/around_lens.h"
#include "lf/render/collect/frame_lens.h"
#include "lf/render/hybrid/frame_pixels.h"
#include "lf/render/hybrid/gap_lens.h"
#include "lf/selection/ideal_cells.h"
#include "lf/selection/overlap.h"

namespace lf {
namespace {

// Near() may use FrameLens::near() instead of ImagesNearLens(), because both have the same reach.
static_assert(FrameLens::kReach_distances == kFarthestDistances);
// The neighbours contain the LF cameras that complete gaps.
static_assert(GapLens::kFarthestDistances == kFarthestDistances);

std::optional<double> DistanceOf(const std::optional<FrameSampling>& sampling) {
  if (!sampling) return std::nullopt;
  return sampling->lf.camera_distance_w;
}

// Adds the pixels around those that frames ask for, from which the edges in LF images are found.
void GrowByEdges(const ImageIndex& index, const NeedsOptions& options,
                 std::vector<FrameNeeds::Image>* images) {
  const int around_px = PixelsAround(options.rebin.rebin.probability, true);
  for (FrameNeeds::Image& image : *images)
    image.rect = GrownBy(image.rect, around_px, index.light_field().Camera(image.id).intrinsics);
}

// Merges `others` into `images`. Both lists are by ascending ranks.
void Join(const ImageIndex& index, const std::vector<FrameNeeds::Image>& others,
          std::vector<FrameNeeds::Image>* images) {
  const auto rank = [&index](const FrameNeeds::Image& image) { return index.RankOf(image.id); };
  std::vector<FrameNeeds::Image> joined;
  auto next = others.begin();
  for (const FrameNeeds::Image& image : *images) {
    while (next != others.end() && rank(*next) < rank(image)) joined.push_back(*next++);
    joined.push_back(image);
    if (next == others.end() || next->id != image.id) continue;
    joined.back().rect = Bounds(image.rect, next->rect);
    joined.back().ray_count += next->ray_count;
    ++next;
  }
  joined.insert(joined.end(), next, others.end());
  *images = std::move(joined);
}

// Returns the LF images, and their pixels, that complete the gaps of a frame's lenses.
std::vector<FrameNeeds::Image> ImagesOfGaps(const ImageIndex& index, std::span<const GapLens> gaps,
                                            const RankRange& ranks, const NeedsOptions& options,
                                            ThreadPool& pool) {
  KeptFrame kept;
  kept.ranks = ranks;
  std::vector<TakingFrame> taking;
  for (const GapLens& gap : gaps) {
    if (!gap.exists()) continue;
    kept.gaps.push_back(&gap);
    taking.push_back({gap.camera(), ranks, [&gap](LfImageId id) { return gap.Takes(id); }});
  }
  std::vector<FrameNeeds::Image> images;
  if (taking.empty()) return images;
  for (const SelectedImage& image : SelectImages(index, taking, options.select, pool)) {
    const PinholeCamera camera = index.light_field().Camera(image.id);
    std::vector<IdealCell> cells;
    if (camera.intrinsics.has_distortion()) cells = MakeIdealCells(camera.intrinsics);
    const ImageOverlap overlap(camera, cells, options.select.reach);
    FrameNeeds::Image needed{image.id, {}, 0};
    for (const PixelRect& rect : AskedRects(kept, image.id, overlap, image.rank)) {
      needed.rect = Bounds(needed.rect, rect);
      needed.ray_count += static_cast<uint64_t>(rect.pixel_count());
    }
    if (needed.rect.empty()) continue;
    images.push_back(needed);
  }
  GrowByEdges(index, options, &images);
  return images;
}

// Adds what completes the gaps of a frame's lenses, one for each of its instants.
//   distances_w  distances between LF cameras around the lenses; empty: measured in `index`
void AddGaps(const ImageIndex& index, std::span<const RenderCamera> instants,
             std::span<const FrameLens> lenses, const RankRange& ranks, const NeedsOptions& options,
             std::span<const double> distances_w, ThreadPool& pool, FrameNeeds* needs) {
  const auto images_of = [&](std::span<const FrameLens> collected) {
    std::vector<GapLens> gaps;
    for (size_t i = 0; i < instants.size(); ++i)
      gaps.emplace_back(index, instants[i], collected[i], ranks, options.select, pool,
                        i < distances_w.size() ? std::optional(distances_w[i]) : std::nullopt);
    return ImagesOfGaps(index, gaps, ranks, options, pool);
  };
  const std::vector<FrameNeeds::Image> images = images_of(lenses);
  for (const FrameNeeds::Image& image : images) needs->rebinned_count += image.ray_count;
  Join(index, images, &needs->images);
  if (options.lens_weights != LensWeights::kAuto) return;
  // A rule that counts rays leaves out lens weights, and the lens then has other gaps.
  std::vector<FrameLens> plain;
  for (const RenderCamera& instant : instants)
    plain.emplace_back(index, instant, LensWeights::kNone, options.select, pool);
  std::vector<FrameNeeds::Image> others = images_of(plain);
  for (FrameNeeds::Image& image : others) image.ray_count = 0;
  Join(index, others, &needs->images);
}

class NeedsFinder {
 public:
  //   lens  lens of the frame; must outlive the object
  NeedsFinder(const ImageIndex& index, const RenderCamera& frame, const FrameLens& lens,
              const NeedsOptions& options, ThreadPool& pool,
              const std::optional<FrameSampling>& sampling)
      : index_(index),
        frame_(frame),
        options_(options),
        pool_(pool),
        distance_w_(DistanceOf(sampling)),
        lens_(lens) {
    if (&index.recorded() != &index || (sampling && sampling->recorded_distance_w))
      recorded_lens_.emplace(index.recorded(), frame, options.lens_weights, options.select, pool,
                             sampling ? sampling->recorded_distance_w : std::nullopt);
    LF_CHECK(!options.KeepsCells() || !options.max_image_count);
    LF_CHECK(!options.KeepsOnlyCells() || options.lens_weights == LensWeights::kNone);
    needs_.sampling = sampling;
  }

  // Returns the needs of the lens without those that follow from collected or rebinned rays: the
  // LF cameras around the lens are neighbours.
  FrameNeeds FindAround() {
    FindNeighbours();
    return std::move(needs_);
  }

  FrameNeeds Find() {
    if (!options_.KeepsOnlyCells()) AddCollected();
    if (options_.KeepsCells()) AddRebinned();
    if (options_.KeepsPixels() && Collects(options_.mode)) {
      AddGaps(index_, {&frame_, 1}, {&lens_, 1}, ranks_, options_,
              distance_w_ ? std::span(&*distance_w_, 1) : std::span<const double>(), pool_,
              &needs_);
    } else if (options_.KeepsPixels()) {
      GrowByEdges(index_, options_, &needs_.images);
    }
    if (options_.HasNeighbours()) FindNeighbours();
    return std::move(needs_);
  }

 private:
  void AddCollected() {
    const FrameLens& counted = is_guarded() ? *recorded_lens_ : lens_;
    std::vector<TakingFrame> frames = {Taking(counted)};
    if (options_.max_image_count)
      ranks_ = RanksOfFirst(*options_.max_image_count, is_guarded() ? index_.recorded() : index_,
                            frames[0], options_.select);
    if (is_guarded()) frames.push_back(Taking(lens_));
    for (TakingFrame& frame : frames) frame.ranks = ranks_;
    for (const SelectedImage& image : SelectImages(index_, frames, options_.select, pool_))
      needs_.images.push_back({image.id, image.rect, image.ray_count});
  }

  bool is_guarded() const { return options_.guard && recorded_lens_; }

  TakingFrame Taking(const FrameLens& lens) const {
    TakingFrame frame = {lens.camera()};
    if (options_.lens_weights != LensWeights::kNone || options_.guard)
      frame.takes = [&lens](LfImageId id) { return lens.Takes(id); };
    return frame;
  }

  void AddRebinned() {
    CollectedWeights collected;
    if (Collects(options_.mode)) collected = [this](LfImageId id) { return lens_.WeightsOf(id); };
    const LensGaps gaps(index_, frame_, collected, lens_.tests_opening(), {}, options_.select,
                        options_.rebin.query, pool_, distance_w_);
    const AskedPixels asked(gaps, Collects(options_.mode), options_.rebin.previews);
    if (!asked.AsksForAny()) return;
    std::vector<FrameNeeds::Image> rebinned;
    for (const SelectedImage& image :
         SelectImages(index_, std::span(&asked.camera(), 1), options_.select, pool_)) {
      const PixelRect rect = RebinnedRect(asked, image);
      if (rect.empty()) continue;
      rebinned.push_back({image.id, rect, static_cast<uint64_t>(rect.pixel_count())});
      needs_.rebinned_count += rebinned.back().ray_count;
    }
    Join(rebinned);
  }

  void Join(const std::vector<FrameNeeds::Image>& others) {
    lf::Join(index_, others, &needs_.images);
  }

  PixelRect RebinnedRect(const AskedPixels& asked, const SelectedImage& image) const {
    const LightField& light_field = index_.light_field();
    const PinholeCamera camera = light_field.Camera(image.id);
    std::vector<IdealCell> cells;
    if (camera.intrinsics.has_distortion()) cells = MakeIdealCells(camera.intrinsics);
    const ImageOverlap overlap(camera, cells, options_.select.reach);
    const PixelRect rect =
        asked.RectOf(light_field.cameras[image.id.value], overlap, image.rank, options_.select);
    return GrownBy(rect, PixelsAround(options_.rebin.rebin, true), camera.intrinsics);
  }

  // Finds the LF cameras that are needed for lens weights, gaps of the lens, and rebinned rays with
  // the default QueryOptions. Includes the LF cameras that any mode or estimator needs, so that a
  // package serves all modes and estimators.
  void FindNeighbours() {
    SelectOptions widest = options_.select;
    widest.reach = kWidestReach;
    std::vector<SelectedImage> near = Near(widest);
    if (!needs_.sampling) needs_.sampling = SamplingOf(index_, frame_, near, CameraDistance());
    const double reach_w = NeighbourReach_w(frame_, *needs_.sampling);
    if (reach_w > kFarthestDistances * needs_.sampling->lf.camera_distance_w) {
      RenderCamera grown = frame_;
      grown.aperture = {frame_.aperture.radius_w + reach_w, 0, 0};
      near = SelectImages(index_, std::span(&grown, 1), widest, pool_);
    }
    std::vector<LfImageId> all, read;
    for (const SelectedImage& image : near) all.push_back(image.id);
    // If LF cameras are far apart, their hat weights reach farther than reach_w.
    if (lens_.camera().aperture.radius_w > frame_.aperture.radius_w + reach_w)
      for (const SelectedImage& image :
           SelectImages(index_, std::span(&lens_.camera(), 1), widest, pool_))
        all.push_back(image.id);
    if (recorded_lens_)
      for (const LfImageId id : recorded_lens_->near()) all.push_back(id);
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    for (const FrameNeeds::Image& image : needs_.images) read.push_back(image.id);
    std::sort(read.begin(), read.end());
    std::set_difference(all.begin(), all.end(), read.begin(), read.end(),
                        std::back_inserter(needs_.neighbours));
  }

  double CameraDistance() const {
    if (options_.lens_weights != LensWeights::kNone) return lens_.camera_distance_w();
    return distance_w_ ? *distance_w_ : CameraDistanceAround(index_, frame_);
  }

  // Returns the LF images near the lens, by ascending ranks.
  std::vector<SelectedImage> Near(const SelectOptions& widest) const {
    if (options_.lens_weights == LensWeights::kNone || options_.select.reach != widest.reach)
      return ImagesNearLens(index_, frame_, CameraDistance(), widest, pool_);
    std::vector<SelectedImage> near;
    for (const LfImageId id : lens_.near()) {
      SelectedImage image;
      image.id = id;
      image.rank = index_.RankOf(id);
      near.push_back(image);
    }
    std::sort(near.begin(), near.end(),
              [](const SelectedImage& a, const SelectedImage& b) { return a.rank < b.rank; });
    return near;
  }

  const ImageIndex& index_;
  const RenderCamera& frame_;
  const NeedsOptions& options_;
  ThreadPool& pool_;
  const std::optional<double> distance_w_;
  const FrameLens& lens_;
  std::optional<FrameLens> recorded_lens_;  // set if the whole light field has virtual LF images
  RankRange ranks_;                         // ranks of the LF images that the frame takes
  FrameNeeds needs_;
};

}  // namespace

std::optional<double> FrameNeeds::camera_distance_w() const { return DistanceOf(sampling); }

uint64_t FrameNeeds::RayCount() const {
  uint64_t count = 0;
  for (const Image& image : images) count += image.ray_count;
  return count;
}

FrameSurroundings SurroundingsOf(const FrameSampling& sampling) {
  return {sampling.lf.camera_distance_w, sampling.lf.pixel_rad, sampling.lf.middle_world,
          sampling.hole_w, sampling.recorded_distance_w};
}

FrameSampling SamplingOf(const FrameSurroundings& surroundings) {
  return {{surroundings.camera_distance_w, surroundings.pixel_rad, surroundings.middle_world},
          surroundings.hole_w,
          surroundings.recorded_distance_w};
}

std::optional<FrameSampling> SamplingOf(const Package& package, FrameId frame) {
  if (package.surroundings.empty()) return std::nullopt;
  return SamplingOf(package.surroundings[package.path.frames().IndexOf(frame)]);
}

FrameNeeds NeedsOf(const ImageIndex& index, const RenderCamera& frame, const NeedsOptions& options,
                   ThreadPool& pool, const std::optional<FrameSampling>& sampling) {
  const FrameLens lens(index, frame, options.lens_weights, options.select, pool,
                       DistanceOf(sampling));
  return NeedsFinder(index, frame, lens, options, pool, sampling).Find();
}

FrameNeeds NeedsOf(const ImageIndex& index, const CameraPath& path, FrameId frame,
                   const NeedsOptions& options, ThreadPool& pool, const Package* package) {
  const std::optional<FrameSampling> sampling =
      package != nullptr ? SamplingOf(*package, frame) : std::nullopt;
  if (!path.shutter.exists()) return NeedsOf(index, path.Camera(frame), options, pool, sampling);
  LF_CHECK(!options.KeepsCells() && !options.guard);
  const std::span<const RenderCamera> instants = path.Instants(frame);
  const std::span<const double> distances_w =
      package != nullptr ? package->InstantDistances(frame) : std::span<const double>();
  const std::vector<FrameLens> lenses =
      LensesOf(index, instants, options.lens_weights, options.select, pool, distances_w);
  std::vector<TakingFrame> taking;
  for (const FrameLens& lens : lenses) {
    taking.push_back({lens.camera()});
    if (options.lens_weights != LensWeights::kNone)
      taking.back().takes = [&lens](LfImageId id) { return lens.Takes(id); };
  }
  RankRange ranks;
  if (options.max_image_count)
    ranks = RanksOfFirst(*options.max_image_count, index, taking, options.select);
  for (TakingFrame& instant : taking) instant.ranks = ranks;
  FrameNeeds needs;
  for (const SelectedImage& image : SelectImages(index, taking, options.select, pool))
    needs.images.push_back({image.id, image.rect, image.ray_count});
  if (options.KeepsPixels() && Collects(options.mode)) {
    AddGaps(index, instants, lenses, ranks, options, distances_w, pool, &needs);
  } else if (options.KeepsPixels()) {
    GrowByEdges(index, options, &needs.images);
  }
  if (!options.HasNeighbours()) return needs;

  needs.sampling =
      sampling ? *sampling : SamplingOf(index, path.Camera(frame), options.select, pool);
  std::vector<LfImageId> around, read;
  for (size_t i = 0; i < instants.size(); ++i) {
    std::optional<FrameSampling> of_instant;
    if (sampling && !distances_w.empty()) {
      of_instant = *sampling;
      of_instant->lf.camera_distance_w = distances_w[i];
    }
    const FrameNeeds found =
        NeedsFinder(index, instants[i], lenses[i], options, pool, of_instant).FindAround();
    around.insert(around.end(), found.neighbours.begin(), found.neighbours.end());
    needs.instant_distances_w.push_back(found.sampling->lf.camera_distance_w);
  }
  std::sort(around.begin(), around.end());
  around.erase(std::unique(around.begin(), around.end()), around.end());
  for (const FrameNeeds::Image& image : needs.images) read.push_back(image.id);
  std::sort(read.begin(), read.end());
  std::set_difference(around.begin(), around.end(), read.begin(), read.end(),
                      std::back_inserter(needs.neighbours));
  return needs;
}

Result<void> CheckKept(const LfImageStore& store, const LightField& light_field, FrameId frame,
                       const FrameNeeds& needs) {
  for (const FrameNeeds::Image& image : needs.images)
    if (!store.Keeps(image.id, image.rect))
      return InputError(fmt::format(
          "{}: this packed store lacks pixels that frame {} needs of {}, because it was made for "
          "other frames, for another {{mode}}, {{estimator}} or {{lens_weights}}, or by a version "
          "that reads fewer pixels of mosaics: compress the "
          "original light field again, as a whole or from packages of these frames and options",
          light_field.folder.string(), frame.value, light_field.image_names[image.id.value]));
  return {};
}

Error NoneContributes(std::span<const FrameId> frames) {
  return InputError(fmt::format(
      "no LF image contributes to any of the frames {} to {}: no recorded ray passes through both "
      "their lens and the region that they see (is the aperture smaller than the distance between "
      "LF cameras, or the render camera far from the LF cameras?)",
      frames.front().value, frames.back().value));
}

}  // namespace lf
