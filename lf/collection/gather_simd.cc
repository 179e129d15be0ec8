// SPDX-License-Identifier: Apache-2.0
// The inner loop of the estimator *bilinear*, compiled for every instruction set from one source
// (Highway). Polynomials are evaluated for a vector of positions at a time. Four or sixteen pixels,
// each of four lanes of 16 bits, are then mixed in integers (means of several rays also in single
// precision) and added to the element. There is no fused multiply-add, so that results are
// bit-identical on every instruction set.
#include <algorithm>
#include <vector>

#include "lf/collection/gather.h"
#include "lf/collection/tile_weights.h"
#include "lf/core/check.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lf/collection/gather_simd.cc"  // NOLINT: as Highway wants it
#include <hwy/foreach_target.h>
// These must be included after foreach_target.h.
#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include "lf/collection/bilinear_simd-inl.h"
#include "lf/collection/cubic_simd-inl.h"
#include "lf/collection/element_means_simd-inl.h"
#include "lf/collection/gather_places_simd-inl.h"
#include "lf/collection/ray_weight_simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lf {
namespace HWY_NAMESPACE {

// True if `rect` holds the sixteen pixels around each of the rays [begin, begin + count) of the
// segment. May be false even if `rect` holds them, if a ray is near the border.
//   is_even  Prefilter::is_even: the pixels are knots, half a pixel to the right of pixels' centres
bool IsInner(const Segment& s, int begin, int count, const PixelRect& rect, bool is_even) {
  const float t = s.t_begin + static_cast<float>(begin);
  const float shift = is_even ? 0.5F : 0;
  const auto is_inner = [shift](const PositionRange& range, int base, int pixel_begin,
                                int pixel_end) {
    constexpr float kBorder = 1.51F;
    return static_cast<float>(base - pixel_begin) + range.low >= kBorder + shift &&
           static_cast<float>(base - pixel_end) + range.high <= -kBorder + shift;
  };
  return is_inner(RangeOf(s.x_poly, t, count), s.base_x, rect.x_begin, rect.x_end) &&
         is_inner(RangeOf(s.y_poly, t, count), s.base_y, rect.y_begin, rect.y_end);
}

// Adds rays that are interpolated between the pixels at `places`: ray i to element i of `sums`.
template <bool kIsCubic, class Weights>
class RayAdder {
 public:
  HWY_INLINE RayAdder(const Places& places, const LfPixels& pixels, int step_px,
                      const Weights& weights, TileSums::Element* sums)
      : places_(places),
        width_(pixels.rect.width()),
        height_(pixels.rect.height()),
        values_(pixels.radiance.row(0)),
        row_values_(static_cast<ptrdiff_t>(width_) * LfPixels::kRgbLanes),
        ahead_values_(row_values_ * std::max(2, step_px)),
        reads_new_rows_(step_px > 1),
        weights_(weights),
        sums_(sums),
        cubics_(TablesOfCubics()) {}

  // Returns the upper left one of the four pixels of ray i.
  HWY_INLINE const uint16_t* Upper(int i) const {
    LF_DCHECK(places_.pixel[i] >= 0 && places_.pixel[i] < width_ * (height_ - 1) - 1);
    return values_ + static_cast<ptrdiff_t>(places_.pixel[i]) * LfPixels::kRgbLanes;
  }

  // Prefetches the cache lines of pixels that the element below that of ray i will need, or, if
  // elements are as wide as LF pixels, the element below that one. The processor does not prefetch
  // rows by itself, because they are too far apart. It can have few pending requests at a time;
  // therefore lines are requested one by one.
  HWY_INLINE void FetchAhead(int i) const {
    const uint16_t* const upper = Upper(i) + ahead_values_;
    hwy::Prefetch(upper + row_values_);
    if (reads_new_rows_) hwy::Prefetch(upper);
  }

  // True if the four pixels of ray i, and `outer` more rows and columns on each side, are loaded
  // and not masked.
  bool HasAll(int i, int outer) const {
    const int x = places_.pixel[i] % width_, y = places_.pixel[i] / width_;
    if (x < outer || x + 1 + outer >= width_ || y < outer || y + 1 + outer >= height_) return false;
    const int taps = 2 + 2 * outer;
    const uint16_t* const ray =
        Upper(i) - outer * (row_values_ + LfPixels::kRgbLanes) + LfPixels::kRayLane;
    int unmasked = 0;
    for (int tap = 0; tap < taps * taps; ++tap)
      unmasked += ray[tap / taps * row_values_ + ptrdiff_t{tap % taps} * LfPixels::kRgbLanes];
    return unmasked == taps * taps;
  }

  // AddOfFour() adds ray i, interpolated between four pixels. Add() interpolates between sixteen if
  // kIsCubic is true.
  HWY_ATTR HWY_INLINE void AddOfFour(int i) const {
    AddRay<Weights>(places_, i, values_, row_values_, weights_, sums_);
  }
  HWY_ATTR HWY_INLINE void Add(int i) const {
    if constexpr (kIsCubic)
      AddCubicRay(cubics_, places_.left_right[i] >> 16, places_.lower[i],
                  Upper(i) - row_values_ - LfPixels::kRgbLanes, row_values_, weights_, i, sums_);
    else
      AddOfFour(i);
  }

  // Adds rays [i, i + kCount).
  template <int kCount>
  HWY_ATTR HWY_INLINE void AddAll(int i) const {
    if constexpr (kIsCubic)
      for (int k = i; k < i + kCount; ++k) Add(k);
    else
      for (int k = i; k < i + kCount; k += kRaysAtOnce)
        AddRays(places_, k, values_, row_values_, weights_, sums_);
  }

 private:
  const Places& places_;
  int width_, height_;
  const uint16_t* values_;
  ptrdiff_t row_values_, ahead_values_;
  bool reads_new_rows_;  // true: no row of pixels is read by two rows of elements
  const Weights weights_;
  TileSums::Element* sums_;
  const CubicTables& cubics_;
};

// Adds the rays of elements [begin, begin + count) of the segment; `weights` and `sums` begin at
// the first of these elements. Returns the number of rays.
template <bool kIsCubic, bool kMayBeMasked, class Weights>
HWY_ATTR uint32_t GatherPart(const Segment& s, int begin, int count, const GatherSampling& sampling,
                             const LfPixels& pixels, const Weights& weights,
                             TileSums::Element* sums) {
  constexpr int kLinePixels = 8;  // pixels of an LF image in a cache line
  const int line_elements = std::max(1, kLinePixels / sampling.step_px);
  Places places;
  FindPlaces(s, begin, count, pixels.rect, sampling, &places);
  const RayAdder<kIsCubic, Weights> adder(places, pixels, sampling.step_px, weights, sums);
  if (kMayBeMasked ||
      (kIsCubic && !IsInner(s, begin, count, pixels.rect, sampling.prefilter.is_even))) {
    uint32_t rays = 0;
    for (int i = 0; i < count; ++i) {
      if (i % line_elements == 0) adder.FetchAhead(i);
      if (kIsCubic && adder.HasAll(i, 1))
        adder.Add(i);
      else if (adder.HasAll(i, 0))
        adder.AddOfFour(i);
      else
        continue;
      ++rays;
    }
    return rays;
  }
  int i = 0;
  for (; i + kLinePixels <= count; i += kLinePixels) {
    for (int k = i; k < i + kLinePixels; k += line_elements) adder.FetchAhead(k);
    adder.template AddAll<kLinePixels>(i);
  }
  for (; i < count; ++i) adder.Add(i);
  return static_cast<uint32_t>(count);
}

template <bool kIsCubic, class Weights>
auto GatherPartOf(const LfPixels& pixels) {
  return pixels.any_masked ? GatherPart<kIsCubic, true, Weights>
                           : GatherPart<kIsCubic, false, Weights>;
}

// Adds to each element of the tile its one ray, if it has one. Returns the number of rays.
template <bool kIsCubic, class Weights>
HWY_ATTR uint64_t GatherRays(const GatherPlan& plan, const LfPixels& pixels, const Weights& weights,
                             const PixelRect& tile, int stride, TileSums::Element* elements) {
  const auto gather = GatherPartOf<kIsCubic, Weights>(pixels);
  uint64_t rays = 0;
  for (int y = tile.y_begin; y < tile.y_end; ++y) {
    const ptrdiff_t row = static_cast<ptrdiff_t>(y - tile.y_begin) * stride;
    for (size_t i = plan.row_begin[y]; i < plan.row_begin[y + 1]; ++i) {
      const Segment& s = plan.segments[i];
      const int begin = std::max(s.x_begin, tile.x_begin);
      const int end = std::min(s.x_begin + s.count, tile.x_end);
      if (begin >= end) continue;
      const ptrdiff_t element = row + (begin - tile.x_begin);
      rays += gather(s, begin - s.x_begin, end - begin, plan.sampling, pixels,
                     weights.From(element), elements + element);
    }
  }
  return rays;
}

// Adds the mean of several rays to each element. The rays of a row of elements are first summed in
// a row of finer elements, `samples` for each element. Returns the number of elements that have a
// ray.
template <bool kIsCubic, class Weights>
HWY_ATTR uint64_t GatherMeans(const GatherPlan& plan, const LfPixels& pixels,
                              const Weights& weights, const PixelRect& tile, int stride,
                              TileSums::Element* elements) {
  const auto gather = GatherPartOf<kIsCubic, WeightOne>(pixels);
  const int samples = plan.sampling.samples;
  thread_local std::vector<TileSums::Element> fine;
  uint64_t rays = 0;
  // The row is cut into chunks, so that the finer elements of a chunk, and the pixel indices and
  // weights of its rays (`Places`), stay in the L1 cache.
  const int chunk = std::max(16, 256 / samples);
  for (int x_begin = tile.x_begin; x_begin < tile.x_end; x_begin += chunk) {
    const int x_end = std::min(tile.x_end, x_begin + chunk);
    const int fine_begin = x_begin * samples, fine_end = x_end * samples;
    for (int y = tile.y_begin; y < tile.y_end; ++y) {
      fine.assign(static_cast<size_t>(fine_end - fine_begin), {});
      bool any = false;
      for (size_t i = plan.row_begin[static_cast<size_t>(y) * samples];
           i < plan.row_begin[static_cast<size_t>(y + 1) * samples]; ++i) {
        const Segment& s = plan.segments[i];
        const int begin = std::max(s.x_begin, fine_begin);
        const int end = std::min(s.x_begin + s.count, fine_end);
        if (begin >= end) continue;
        any = true;
        gather(s, begin - s.x_begin, end - begin, plan.sampling, pixels, WeightOne(),
               fine.data() + (begin - fine_begin));
      }
      if (!any) continue;
      const ptrdiff_t element =
          static_cast<ptrdiff_t>(y - tile.y_begin) * stride + (x_begin - tile.x_begin);
      rays += AddMeans(fine.data(), samples, x_end - x_begin, weights.From(element),
                       elements + element);
    }
  }
  return rays;
}

template <bool kIsCubic, class Weights>
uint64_t GatherAs(const GatherPlan& plan, const LfPixels& pixels, const Weights& weights,
                  const TileSums& sums, TileSums::Element* elements) {
  const auto gather =
      plan.sampling.samples == 1 ? GatherRays<kIsCubic, Weights> : GatherMeans<kIsCubic, Weights>;
  return gather(plan, pixels, weights, sums.rect(), sums.stride(), elements);
}

// Adds the rays of `plan` to the tile of `sums`. Returns the number of rays.
//   most_weight  the largest of the weights
template <class Weights>
uint64_t GatherBy(const GatherPlan& plan, const LfPixels& pixels, const Weights& weights,
                  uint32_t most_weight, TileSums* sums) {
  const auto gather = plan.sampling.is_cubic ? GatherAs<true, Weights> : GatherAs<false, Weights>;
  // Each element gets at most one ray, so that the sums need room for only one more ray.
  TileSums::Element* const elements = sums->ReserveRgb(most_weight);
  return gather(plan, pixels, weights, *sums, elements);
}

HWY_ATTR uint64_t GatherTile(const GatherPlan& plan, const LfPixels& pixels,
                             const TileWeights& weights, TileSums* sums) {
  const uint32_t most = weights.most();
  if (weights.least() < most)
    return GatherBy(plan, pixels, WeightByElement{weights.data()}, most, sums);
  if (most > 1) return GatherBy(plan, pixels, WeightSame{most}, most, sums);
  return GatherBy(plan, pixels, WeightOne(), 1, sums);
}

}  // namespace HWY_NAMESPACE
}  // namespace lf
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lf {
HWY_EXPORT(GatherTile);

namespace {

// Returns a rectangle that contains all elements of `tile` with a ray; empty if there are none. It
// is the smallest one unless there are gaps between the segments of a row.
PixelRect RectOfRays(const GatherPlan& plan, const PixelRect& tile) {
  const int samples = plan.sampling.samples;
  // Positions on the finer plate.
  const int tile_begin = tile.x_begin * samples, tile_end = tile.x_end * samples;
  int x_begin = tile_end, x_end = tile_begin;
  int y_begin = tile.y_end, y_end = tile.y_begin;
  for (int y = tile.y_begin; y < tile.y_end; ++y) {
    const size_t first_row = static_cast<size_t>(y) * samples;
    for (size_t row = first_row; row < first_row + samples; ++row) {
      if (plan.row_begin[row] == plan.row_begin[row + 1]) continue;
      const Segment& last = plan.segments[plan.row_begin[row + 1] - 1];
      const int begin = std::max(plan.segments[plan.row_begin[row]].x_begin, tile_begin);
      const int end = std::min(last.x_begin + last.count, tile_end);
      if (begin >= end) continue;
      x_begin = std::min(x_begin, begin);
      x_end = std::max(x_end, end);
      y_begin = std::min(y_begin, y);
      y_end = y + 1;
    }
  }
  return {x_begin / samples, y_begin, (x_end + samples - 1) / samples, y_end};
}

}  // namespace

uint64_t GatherTile(const GatherPlan& plan, const LfPixels& pixels, TileSums* sums,
                    const RayWeights& weights) {
  LF_CHECK(pixels.bayer == BayerPattern::kNone);
  LF_CHECK(sums->rect().x_end <= plan.plate_width && sums->rect().y_end <= plan.plate_height);
  if (plan.segments.empty()) return 0;
  LF_CHECK(pixels.rect.width() >= 2 && pixels.rect.height() >= 2);
  const PixelRect& tile = sums->rect();
  // Weights are found only for the part of the tile with rays, because most LF images have rays in
  // a part of the plate.
  const PixelRect rays = weights.are_same() ? tile : RectOfRays(plan, tile);
  if (rays.empty()) return 0;
  thread_local TileWeights tile_weights;
  tile_weights.Fill(weights, rays, tile, sums->stride());
  if (tile_weights.most() == 0) return 0;
  return HWY_DYNAMIC_DISPATCH(GatherTile)(plan, pixels, tile_weights, sums);
}

}  // namespace lf
#endif
