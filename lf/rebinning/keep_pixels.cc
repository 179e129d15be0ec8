// SPDX-License-Identifier: Apache-2.0
#include "lf/rebinning/keep_pixels.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "lf/core/check.h"
#include "lf/rebinning/pixel_chances.h"
#include "lf/rebinning/probability_map.h"

namespace lf {
namespace {

using Runs = std::vector<std::pair<int, int>>;

// Finds the runs of columns [begin, end) of a row that are in at least one of the rectangles, from
// left to right.
void FindRuns(std::span<const PixelRect> rects, int y, Runs* runs) {
  runs->clear();
  for (const PixelRect& rect : rects)
    if (y >= rect.y_begin && y < rect.y_end && rect.x_begin < rect.x_end)
      runs->emplace_back(rect.x_begin, rect.x_end);
  std::sort(runs->begin(), runs->end());
  size_t last = 0;
  for (size_t i = 1; i < runs->size(); ++i) {
    if ((*runs)[i].first <= (*runs)[last].second)
      (*runs)[last].second = std::max((*runs)[last].second, (*runs)[i].second);
    else
      (*runs)[++last] = (*runs)[i];
  }
  if (!runs->empty()) runs->resize(last + 1);
}

PixelRect BoundsOf(std::span<const PixelRect> rects) {
  PixelRect bounds;
  for (const PixelRect& rect : rects) bounds = Bounds(bounds, rect);
  return bounds;
}

class PixelKeeper {
 public:
  PixelKeeper(const LfPixels& pixels, const Image<uint16_t>& opacity, KeptImage* image)
      : pixels_(pixels), opacity_(opacity), image_(*image) {}

  // Keeps a pixel, or marks it as masked.
  void Keep(int x, int y) {
    const int column = x - pixels_.rect.x_begin, row = y - pixels_.rect.y_begin;
    image_.places.push_back(image_.PlaceOf(x, y));
    const int colours = pixels_.bayer == BayerPattern::kNone ? 3 : 1;
    for (int c = 0; c < colours; ++c) image_.values.push_back(pixels_.radiance.at(column, row, c));
    if (image_.has_opacity) image_.values.push_back(opacity_.at(column, row, 0));
    if (image_.has_trust) image_.values.push_back(pixels_.trust.at(column, row));
  }

  bool IsMasked(int x, int y) const {
    return pixels_.any_masked &&
           pixels_.IsMasked(x - pixels_.rect.x_begin, y - pixels_.rect.y_begin);
  }

  void Mask(int x, int y) {
    if (image_.masked.empty()) image_.masked.assign(image_.masked_words(), 0);
    const uint32_t place = image_.PlaceOf(x, y);
    image_.masked[place / 64] |= uint64_t{1} << (place % 64);
  }

 private:
  const LfPixels& pixels_;
  const Image<uint16_t>& opacity_;
  KeptImage& image_;
};

}  // namespace

KeptImage KeepPixels(LfImageId id, const Intrinsics& k, const LfPixels& pixels,
                     const Image<uint16_t>& opacity, std::span<const PixelRect> asked,
                     bool keeps_all, const std::vector<uint16_t>& stored_values,
                     const RebinOptions& options) {
  KeptImage image;
  image.id = id;
  image.width_px = k.width_px;
  image.height_px = k.height_px;
  image.bayer = pixels.bayer;
  image.recorded = pixels.recorded;
  image.has_opacity = !opacity.empty();
  image.has_trust = !pixels.trust.empty();
  image.is_sparse = !keeps_all;
  image.depths = pixels.depths;
  image.rect = BoundsOf(asked);
  if (image.rect.empty()) return image;
  LF_CHECK(Intersection(image.rect, pixels.rect) == image.rect);
  if (keeps_all) {
    const uint64_t count = PixelsIn(asked);
    image.places.reserve(count);
    image.values.reserve(count * image.value_count());
  }
  Image<uint16_t> p;
  if (!keeps_all) {
    ProbabilityMap(pixels, image.rect, stored_values, options.probability, &p);
    // The expected number and four standard deviations; vectors that grow would take twice as much.
    const uint64_t sum = std::accumulate(p.pixels().begin(), p.pixels().end(), uint64_t{0});
    const double expected = static_cast<double>(sum) / 65535;
    const auto count = static_cast<size_t>(expected + 4 * std::sqrt(expected));
    image.places.reserve(count);
    image.values.reserve(count * image.value_count());
  }
  PixelKeeper keeper(pixels, opacity, &image);
  const PixelChances chances(options.seed, id);
  Runs runs;
  std::vector<uint32_t> chosen;
  for (int y = image.rect.y_begin; y < image.rect.y_end; ++y) {
    FindRuns(asked, y, &runs);
    for (const auto& [begin, end] : runs) {
      if (pixels.any_masked)
        for (int x = begin; x < end; ++x)
          if (keeper.IsMasked(x, y)) keeper.Mask(x, y);
      if (keeps_all) {
        for (int x = begin; x < end; ++x)
          if (!keeper.IsMasked(x, y)) keeper.Keep(x, y);
        continue;
      }
      const uint16_t* const of_run = p.row(y - image.rect.y_begin) + (begin - image.rect.x_begin);
      chances.Choose(static_cast<uint64_t>(y) * static_cast<uint64_t>(k.width_px) +
                         static_cast<uint64_t>(begin),
                     {of_run, static_cast<size_t>(end - begin)}, &chosen);
      // p of a masked pixel is 0, so that it is never chosen.
      for (const uint32_t i : chosen) keeper.Keep(begin + static_cast<int>(i), y);
    }
  }
  // A copy would need more memory than a small rest of the reserve, and leave a hole.
  if (image.places.size() < image.places.capacity() / 32 * 31) {
    image.places.shrink_to_fit();
    image.values.shrink_to_fit();
  }
  return image;
}

uint64_t PixelsIn(std::span<const PixelRect> rects) {
  const PixelRect bounds = BoundsOf(rects);
  uint64_t count = 0;
  Runs runs;
  for (int y = bounds.y_begin; y < bounds.y_end; ++y) {
    FindRuns(rects, y, &runs);
    for (const auto& [begin, end] : runs) count += static_cast<uint64_t>(end - begin);
  }
  return count;
}

}  // namespace lf
