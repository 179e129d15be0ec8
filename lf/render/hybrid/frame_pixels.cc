// SPDX-License-Identifier: Apache-2.0
#include "lf/render/hybrid/frame_pixels.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "lf/rebinning/keep_pixels.h"
#include "lf/rebinning/probability_map.h"
#include "lf/render/hybrid/asked_pixels.h"
#include "lf/selection/ideal_cells.h"
#include "lf/selection/overlap.h"

namespace lf {
namespace {

// The pixels that frames ask for are counted in at most this number of LF images, spread over the
// order. All of them are kept if the estimate for all LF images fits in kFittingShare of the room.
constexpr size_t kCountedImages = 256;
constexpr double kFittingShare = 0.9;
// Approximate share of the pixels of an LF image that are at edges.
constexpr double kEdgeShare = 0.1;

void Append(const PixelRect& rect, std::vector<PixelRect>* rects) {
  if (!rect.empty()) rects->push_back(rect);
}

}  // namespace

std::vector<PixelRect> AskedRects(const KeptFrame& frame, LfImageId id, const ImageOverlap& overlap,
                                  uint32_t rank) {
  std::vector<PixelRect> rects;
  if (!frame.ranks.Holds(rank)) return rects;
  for (const FrameLens* lens : frame.lenses)
    if (lens->Takes(id)) Append(overlap.Rect(lens->camera()), &rects);
  for (const GapLens* gap : frame.gaps)
    if (gap->Takes(id)) Append(overlap.Rect(gap->CameraOf(id)), &rects);
  return rects;
}

FramePixels::FramePixels(const ImageIndex& index, std::vector<KeptFrame> frames,
                         std::vector<SelectedImage> images, const SelectOptions& select,
                         const RebinSettings& options, ThreadPool& pool)
    : light_field_(index.light_field()),
      frames_(std::move(frames)),
      images_(std::move(images)),
      select_(select),
      options_(options),
      pool_(pool),
      stored_values_(StoredValueTable(light_field_.encoding)),
      kept_(std::make_unique<KeptPixels>(std::max<size_t>(1, options.max_cells))),
      store_(*kept_) {
  asked_ = CountAsked(images_);
  keeps_all_ = options_.kept == KeptRays::kAll ||
               (options_.kept == KeptRays::kAuto &&
                asked_ <= kFittingShare * static_cast<double>(options_.max_cells));
  rebin_ = options_.rebin;
  // The room that pixels at edges leave is filled with others.
  if (options_.kept == KeptRays::kAuto && !keeps_all_)
    rebin_.probability.xi =
        std::max(rebin_.probability.xi,
                 kFittingShare * static_cast<double>(options_.max_cells) / asked_ - kEdgeShare);
}

// Returns the estimated number of pixels that frames ask for of these LF images.
double FramePixels::CountAsked(std::span<const SelectedImage> images) const {
  const size_t step = 1 + images.size() / kCountedImages;
  std::vector<double> counts((images.size() + step - 1) / step);
  pool_.ForEach(counts.size(), [&](size_t i) {
    const SelectedImage& image = images[i * step];
    counts[i] = static_cast<double>(PixelsIn(RectsOf(image.id, image.rank)));
  });
  return std::accumulate(counts.begin(), counts.end(), 0.0) * static_cast<double>(step);
}

size_t FramePixels::BytesPerPixel(const RadianceEncoding& encoding, Estimator estimator,
                                  bool is_guarded) {
  const bool is_mosaic = encoding.bayer != BayerPattern::kNone && estimator == Estimator::kNearest;
  const size_t value_count =
      (is_mosaic ? 1 : 3) + (encoding.HasOpacity() ? 1 : 0) + (is_guarded ? 1 : 0);
  return sizeof(uint32_t) + value_count * sizeof(uint16_t);
}

size_t FramePixels::FixedBytes(const LightField& light_field, size_t bytes_per_pixel,
                               int thread_count, size_t element_count, bool collects,
                               const MemoryPlan& plan) {
  // While the pixels of an LF image are chosen: probabilities of its pixels, and of the grey
  // picture that they are made of, once more if they are smoothed.
  constexpr size_t kChooseBytes = 3 * sizeof(uint16_t);
  // Memory to decode an LF image, which no thread uses while pixels are chosen.
  constexpr size_t kDecodeBytes = 16;
  // While a tile is filled: up to five values of each pixel, their weight and a copy, as floats, in
  // pictures that are reduced by two again and again, and the counts of known pixels there.
  constexpr size_t kFillBytes = 8 * sizeof(float) * 4 / 3;
  size_t largest = 0;
  for (const Intrinsics& k : light_field.intrinsics)
    largest = std::max(largest, static_cast<size_t>(k.width_px) * static_cast<size_t>(k.height_px));
  const size_t chosen = bytes_per_pixel + kChooseBytes;
  size_t of_thread = std::min(largest, KeptPixels::kTilePixels) * kFillBytes;
  of_thread = std::max(of_thread, largest * (chosen - std::min(chosen, kDecodeBytes)));
  // A batch of one LF image that is made of kept pixels, while the next batch that is read is in
  // memory (MemoryPlan::kept_batch_image_count has a part of the other batches besides).
  size_t bytes = KeptPixels::kFreeBytes + KeptPixels::kFewTogether * bytes_per_pixel +
                 static_cast<size_t>(thread_count) * of_thread + plan.pair_bytes;
  // The plate of a frame's gaps, and what is made of it.
  if (collects) bytes += plan.plate_bytes + CompletionBytes(element_count);
  return bytes;
}

std::vector<PixelRect> FramePixels::RectsOf(LfImageId id, uint32_t rank) const {
  const PinholeCamera camera = light_field_.Camera(id);
  std::vector<IdealCell> cells;
  if (camera.intrinsics.has_distortion()) cells = MakeIdealCells(camera.intrinsics);
  const ImageOverlap overlap(camera, cells, select_.reach);
  std::vector<PixelRect> rects;
  for (const KeptFrame& frame : frames_)
    for (const PixelRect& rect : AskedRects(frame, id, overlap, rank)) rects.push_back(rect);
  // A rectangle inside another one adds nothing; most frames of a film ask for nearly the same.
  std::sort(rects.begin(), rects.end(), [](const PixelRect& a, const PixelRect& b) {
    return a.pixel_count() > b.pixel_count();
  });
  std::vector<PixelRect> outer;
  for (const PixelRect& rect : rects)
    if (std::none_of(outer.begin(), outer.end(),
                     [&](const PixelRect& other) { return Intersection(rect, other) == rect; }))
      outer.push_back(rect);
  return outer;
}

PixelRect FramePixels::RectOf(LfImageId id, uint32_t rank) const {
  PixelRect bounds;
  for (const PixelRect& rect : RectsOf(id, rank)) bounds = Bounds(bounds, rect);
  return GrownBy(bounds, PixelsAround(options_.rebin.probability, true),
                 light_field_.Camera(id).intrinsics);
}

void FramePixels::Take(std::span<const BatchImage> images, uint32_t rank_end) {
  if (rank_end <= ranks_done_) return;
  // Only so many LF images at a time wait to be added, because they are not counted before.
  const auto at_once = static_cast<size_t>(std::max(1, pool_.thread_count()));
  for (size_t begin = 0; begin < images.size(); begin += at_once)
    AddImages(images.subspan(begin, std::min(at_once, images.size() - begin)));
  ranks_done_ = rank_end;
}

void FramePixels::AddImages(std::span<const BatchImage> images) {
  const Image<uint16_t> none;
  std::vector<KeptImage> kept(images.size());
  std::atomic<uint64_t> looked_at = 0;
  pool_.ForEach(images.size(), [&](size_t i) {
    const BatchImage& image = images[i];
    if (image.rank < ranks_done_) return;
    const ThreadCpuTimer timer;
    const std::vector<PixelRect> rects = RectsOf(image.id, image.rank);
    if (rects.empty()) return;
    looked_at += PixelsIn(rects);
    // A guarded frame beside has made opacities also of LF images that have none.
    kept[i] = KeepPixels(image.id, light_field_.Camera(image.id).intrinsics, image.pixels,
                         light_field_.encoding.HasOpacity() ? image.opacity.radiance : none, rects,
                         keeps_all_, stored_values_, rebin_);
    cpu_ns_ += timer.Nanoseconds();
  });
  std::erase_if(kept, [](const KeptImage& image) { return image.rect.empty(); });
  kept_->Add(std::move(kept), pool_);
  looked_at_ += looked_at;
}

void FramePixels::Restore(KeptPixels kept, uint32_t ranks_done) {
  *kept_ = std::move(kept);
  ranks_done_ = ranks_done;
  const auto end =
      std::partition_point(images_.begin(), images_.end(),
                           [&](const SelectedImage& image) { return image.rank < ranks_done; });
  looked_at_earlier_ = CountAsked({images_.begin(), end});
}

FramePixels::Facts FramePixels::facts() const {
  Facts facts{kept_->size(), looked_at_,
              asked_,        static_cast<double>(cpu_ns_) * 1e-9,
              keeps_all_,    kept_->limit() != UINT64_MAX};
  const double looked_at = static_cast<double>(looked_at_) + looked_at_earlier_;
  if ((!facts.keeps_all || facts.is_full) && looked_at > 0)
    facts.kept_share = std::min(1.0, static_cast<double>(facts.pixel_count) / looked_at);
  return facts;
}

std::string FramePixels::Describe() const {
  if (images_.empty()) return "frames ask for no pixels: their lenses have no gaps";
  return fmt::format("frames ask for about {:.3g} million pixels of {} LF images; {} are kept",
                     asked_ * 1e-6, images_.size(), keeps_all_ ? "all" : "those at edges");
}

}  // namespace lf
