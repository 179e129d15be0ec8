// SPDX-License-Identifier: Apache-2.0
// The inner loop of the estimator *nearest*, compiled for every instruction set from one source
// (Highway). Polynomials are evaluated to addresses, for a vector of positions at a time. Values
// are then added in integers: a whole vector at once if neighbouring LF pixels hit neighbouring
// elements (a *run*), otherwise ray by ray. There is no fused multiply-add, so that results are
// bit-identical on every instruction set.
#include <algorithm>
#include <bit>
#include <cmath>

#include "lf/collection/scatter.h"
#include "lf/collection/tile_weights.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lf/collection/scatter_simd.cc"  // NOLINT: as Highway wants it
#include <hwy/foreach_target.h>
// These must be included after foreach_target.h.
#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include "lf/collection/polynomial_simd-inl.h"
#include "lf/collection/ray_weight_simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lf {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr int kGroup = 8;  // number of LF pixels that are added together
// Groups are rarely runs if the step from one position to the next differs from (1, 0) by this many
// elements or more: the elements then change the row, or skip or repeat a column, at least every 1
// / kRareRun pixels.
constexpr float kRareRun = 1.0F / 6;

// An integer below 2^23 is exact in single precision. If it is added to 2^23, the last bits of the
// sum are the integer.
constexpr float kTwoTo23 = 8388608;

// Layout of the sums of a tile. The address of an element is row_stride * row + column, both
// counted from the upper left corner of the tile.
struct TileLayout {
  PixelRect rect;
  int row_stride;         // address of an element minus that of the one above; even for mosaics
  bool has_plate_border;  // true if the tile touches the border of the plate
};

// Adds the rays of a piece of an RGB scanline to the sums of a tile. Pixel i of the piece is added
// to the element with the address start + i, where `start` comes from FindStarts().
template <class Weights>
struct RgbPixels {
  static constexpr int kLanesPerPixel = LfPixels::kRgbLanes;
  const uint16_t* values;        // values of the pixels of the piece, [count][4]
  const uint16_t* values_ahead;  // values of a scanline below, to prefetch
  TileSums::Element* elements;
  Weights weights;  // [i] is the weight of elements[i]
  bool may_be_masked;

  static constexpr bool has_runs() { return true; }

  HWY_ATTR HWY_INLINE void Add(int i, int32_t start) const {
    const uint16_t* v = values + static_cast<ptrdiff_t>(i) * LfPixels::kRgbLanes;
    uint32_t* sums = elements[start + i].rgb_rays;
#if HWY_TARGET == HWY_SCALAR
    for (int lane = 0; lane < LfPixels::kRgbLanes; ++lane)
      sums[lane] += v[lane] * weights.At(start + i);
#else
    const hn::Full128<uint32_t> d32;
    hn::Store(hn::Add(hn::Load(d32, sums), Rays(d32, v, start + i)), d32, sums);
#endif
  }
#if HWY_TARGET != HWY_SCALAR
  // Returns the weighted values of the pixels at `v`, which fall on `element` and the elements
  // after it.
  template <class D>
  HWY_ATTR HWY_INLINE hn::Vec<D> Rays(D d32, const uint16_t* v, int32_t element) const {
    const hn::Rebind<uint16_t, D> d16;
    const auto rays = hn::PromoteTo(d32, hn::LoadU(d16, v));
    if constexpr (Weights::kIsOne)
      return rays;
    else
      return hn::Mul(rays, weights.OfPixels(d32, element));
  }
  HWY_ATTR HWY_INLINE void AddRun(int i, int32_t start) const {
    const hn::CappedTag<uint32_t, 16> d32;
    constexpr int kStep = static_cast<int>(hn::MaxLanes(d32));
    const uint16_t* v = values + static_cast<ptrdiff_t>(i) * LfPixels::kRgbLanes;
    uint32_t* sums = elements[start + i].rgb_rays;
    for (int lane = 0; lane < kGroup * LfPixels::kRgbLanes; lane += kStep)
      hn::StoreU(hn::Add(hn::LoadU(d32, sums + lane),
                         Rays(d32, v + lane, start + i + lane / LfPixels::kRgbLanes)),
                 d32, sums + lane);
  }
  HWY_ATTR HWY_INLINE void AddGroup(int i, const int32_t* starts) const {
    const hn::CappedTag<int32_t, kGroup> d;
    constexpr int kStep = static_cast<int>(hn::MaxLanes(d));
    const auto first = hn::Set(d, starts[0]);
    auto differing = hn::Zero(d);
    for (int k = 0; k < kGroup; k += kStep)
      differing = hn::Or(differing, hn::Xor(hn::LoadU(d, starts + k), first));
    if (HWY_LIKELY(hn::AllTrue(d, hn::Eq(differing, hn::Zero(d))))) {
      AddRun(i, starts[0]);
      return;
    }
    for (int k = 0; k < kGroup; ++k) Add(i + k, starts[k]);
  }
#endif
  uint32_t CountRays(int count) const {
    if (!may_be_masked) return static_cast<uint32_t>(count);
    uint32_t rays = 0;
    for (int i = 0; i < count; ++i) rays += values[i * LfPixels::kRgbLanes + LfPixels::kRayLane];
    return rays;
  }
};

// Adds the rays of a piece of a mosaic's scanline to packed words, each of which holds a sum and a
// count. Addresses are as in RgbPixels.
template <class Weights>
struct MosaicPixels {
  static constexpr int kLanesPerPixel = 1;
  const uint16_t* values;        // values of the pixels of the piece, [count]
  const uint16_t* values_ahead;  // values of a scanline below, to prefetch
  uint64_t* words[2];            // sums of pixels with an even `start` [0], or an odd one [1]
  Weights weights;               // [i] is the weight of word i
  const uint8_t* mask;           // [count], 0: no ray; null if no pixel is masked

  bool has_runs() const { return mask == nullptr; }
  // Returns the word of pixel i. Because row_stride is even, `start` is even if i and the column of
  // the element are both even or both odd. `start` is the same for all pixels of a run.
  uint64_t* WordsOf(int i, int32_t start) const { return words[start & 1] + start + i; }

  void Add(int i, int32_t start) const {
    if (mask != nullptr && mask[i] == 0) return;
    *WordsOf(i, start) += (SensorPlate::kOneRay | values[i]) * weights.At(start + i);
  }
#if HWY_TARGET != HWY_SCALAR
  using Lanes = hn::CappedTag<uint64_t, kGroup>;
  // Returns the packed sums and counts of the pixels from `i` on, which fall on `word` and the
  // words after it.
  HWY_ATTR HWY_INLINE hn::Vec<Lanes> Rays(int i, int32_t word) const {
    const Lanes d64;
    const hn::Rebind<uint32_t, Lanes> d32;
    const hn::Rebind<uint16_t, Lanes> d16;
    const auto sums = hn::PromoteTo(d32, hn::LoadU(d16, values + i));
    if constexpr (Weights::kIsOne) {
      return hn::Or(hn::PromoteTo(d64, sums), hn::Set(d64, SensorPlate::kOneRay));
    } else {
      constexpr int kCountBit = std::countr_zero(SensorPlate::kOneRay);
      const auto weight = weights.OfWords(d32, word);
      return hn::Or(hn::PromoteTo(d64, hn::Mul(sums, weight)),
                    hn::ShiftLeft<kCountBit>(hn::PromoteTo(d64, weight)));
    }
  }
  HWY_ATTR HWY_INLINE void AddRun(int i, int32_t start) const {
    const Lanes d;
    constexpr int kStep = static_cast<int>(hn::MaxLanes(d));
    uint64_t* const sums = WordsOf(i, start);
    for (int k = 0; k < kGroup; k += kStep)
      hn::StoreU(hn::Add(hn::LoadU(d, sums + k), Rays(i + k, start + i + k)), d, sums + k);
  }
  // Most groups consist of one run or two. If there are two, a whole group is added at the words of
  // each run, with zeros in place of the rays of the other run.
  HWY_ATTR HWY_INLINE void AddGroup(int i, const int32_t* starts) const {
    const Lanes d;
    const hn::CappedTag<int32_t, kGroup> d32;
    constexpr int kStep = static_cast<int>(hn::MaxLanes(d));
    constexpr int kStep32 = static_cast<int>(hn::MaxLanes(d32));
    const int32_t first_start = starts[0], last_start = starts[kGroup - 1];
    const auto first = hn::Set(d32, first_start), last = hn::Set(d32, last_start);
    bool are_two = true;
    for (int k = 0; k < kGroup; k += kStep32) {
      const auto start = hn::Load(d32, starts + k);
      are_two &= hn::AllTrue(d32, hn::Or(hn::Eq(start, first), hn::Eq(start, last)));
    }
    if (HWY_UNLIKELY(!are_two)) {
      for (int k = 0; k < kGroup; ++k) Add(i + k, starts[k]);
      return;
    }
    if (first_start == last_start) {
      AddRun(i, first_start);
      return;
    }
    const hn::RebindToSigned<Lanes> d_start;
    const hn::Rebind<int32_t, Lanes> d_half;
    uint64_t *const first_sums = WordsOf(i, first_start), *const last_sums = WordsOf(i, last_start);
    for (int k = 0; k < kGroup; k += kStep) {
      const auto start = hn::PromoteTo(d_start, hn::LoadU(d_half, starts + k));
      const auto is_first = hn::RebindMask(d, hn::Eq(start, hn::Set(d_start, first_start)));
      const auto first_rays = Rays(i + k, first_start + i + k);
      const auto last_rays = Weights::kIsSame ? first_rays : Rays(i + k, last_start + i + k);
      hn::StoreU(hn::Add(hn::LoadU(d, first_sums + k), hn::IfThenElseZero(is_first, first_rays)), d,
                 first_sums + k);
      hn::StoreU(hn::Add(hn::LoadU(d, last_sums + k), hn::IfThenZeroElse(is_first, last_rays)), d,
                 last_sums + k);
    }
  }
#endif
  uint32_t CountRays(int count) const {
    if (mask == nullptr) return static_cast<uint32_t>(count);
    return static_cast<uint32_t>(
        std::count_if(mask, mask + count, [](uint8_t m) { return m != 0; }));
  }
};

// Computes, for each of the positions [begin, begin + count) of a segment, the *start*: the address
// of the element that the position hits, minus the index of the position counted from `begin`.
// Neighbouring positions that hit neighbouring elements have the same start.
//   kClamp  if true, positions that rounding has put outside the tile are moved back to its border
template <int kDegree, bool kClamp>
HWY_ATTR HWY_INLINE void FindStarts(const Segment& s, int begin, int count, const TileLayout& tile,
                                    int32_t* starts) {
  const LaneF df;
  const LaneI di;
  const PolynomialLanes<kDegree> x_poly(s.x_poly), y_poly(s.y_poly);
  const auto row_stride = hn::Set(df, static_cast<float>(tile.row_stride));
  // The upper left corner of the tile, counted from the base of the segment.
  const int left = tile.rect.x_begin - s.base_x, upper = tile.rect.y_begin - s.base_y;
  const auto x_corner = hn::Set(df, static_cast<float>(left));
  const auto y_corner = hn::Set(df, static_cast<float>(upper));
  const auto x_last = hn::Set(df, static_cast<float>(tile.rect.width() - 1));
  const auto y_last = hn::Set(df, static_cast<float>(tile.rect.height() - 1));
  const auto zero = hn::Zero(df);
  const int corner = kClamp ? 0 : upper * tile.row_stride + left;
  const auto base = hn::Set(df, kTwoTo23 - static_cast<float>(corner));
  auto less = hn::Neg(hn::Iota(di, std::bit_cast<int32_t>(kTwoTo23)));
  // t is exact, also after each addition.
  auto t = hn::Iota(df, s.t_begin + static_cast<float>(begin));
  for (int i = 0; i < count; i += kLanes, t = hn::Add(t, hn::Set(df, kLanes))) {
    auto x = hn::Floor(x_poly.At(t)), y = hn::Floor(y_poly.At(t));
    if constexpr (kClamp) {
      x = hn::Min(hn::Max(hn::Sub(x, x_corner), zero), x_last);
      y = hn::Min(hn::Max(hn::Sub(y, y_corner), zero), y_last);
    }
    const auto word = hn::Add(hn::Add(hn::Mul(y, row_stride), x), base);
    hn::Store(hn::Add(hn::BitCast(di, word), less), di, starts + i);
    less = hn::Sub(less, hn::Set(di, kLanes));
  }
}

template <bool kClamp>
HWY_ATTR HWY_INLINE void FindStarts(const Segment& s, int begin, int count, const TileLayout& tile,
                                    int32_t* starts) {
  if (s.is_cubic())
    FindStarts<3, kClamp>(s, begin, count, tile, starts);
  else
    FindStarts<5, kClamp>(s, begin, count, tile, starts);
}

// True if each position of the segment surely hits the element to the right of the element that the
// previous position hits.
bool IsOneRun(const Segment& s) {
  // A position at least this far from the borders of an element hits this element in spite of
  // rounding to single precision.
  constexpr float kMargin = 1e-3F;
  const float place = s.x_poly[0] + s.t_begin, in_element = place - std::floor(place);
  return s.is_cubic() && s.x_poly[1] == 1 && s.x_poly[2] == 0 && s.x_poly[3] == 0 &&
         s.y_poly[1] == 0 && s.y_poly[2] == 0 && s.y_poly[3] == 0 && in_element > kMargin &&
         in_element < 1 - kMargin;
}

template <class Pixels>
HWY_ATTR uint32_t ScatterPiece(const Segment& s, const TilePiece& piece, const Pixels& pixels,
                               const TileLayout& tile) {
  const int count = piece.end - piece.begin;
  // The processor does not prefetch scanlines by itself, because they are too far apart. It can
  // have few pending requests at a time. Cache lines of RGB pixels are therefore prefetched one by
  // one.
  constexpr int kLinePixels = 64 / (Pixels::kLanesPerPixel * static_cast<int>(sizeof(uint16_t)));
  constexpr bool kOneByOne = kLinePixels <= kGroup;
  const auto fetch_ahead = [&](int begin, int end) {
    for (int i = begin; i < end; i += kLinePixels)
      hwy::Prefetch(pixels.values_ahead + static_cast<ptrdiff_t>(i) * Pixels::kLanesPerPixel);
  };
  if (!kOneByOne) fetch_ahead(0, count);
  int i = 0;
#if HWY_TARGET != HWY_SCALAR
  if (IsOneRun(s) && pixels.has_runs()) {
    HWY_ALIGN int32_t start[kLanes];
    FindStarts<true>(s, piece.begin, 1, tile, start);
    for (; i + kGroup <= count; i += kGroup) {
      if (kOneByOne) fetch_ahead(i, i + kGroup);
      pixels.AddRun(i, start[0]);
    }
    for (; i < count; ++i) pixels.Add(i, start[0]);
    return pixels.CountRays(count);
  }
#endif
  // All addresses are computed first and stored: reading them one by one from memory is cheaper
  // than extracting the lanes of a vector.
  HWY_ALIGN int32_t starts[Segment::kMaxCount];
  if (tile.has_plate_border)
    FindStarts<true>(s, piece.begin, count, tile, starts);
  else
    FindStarts<false>(s, piece.begin, count, tile, starts);
#if HWY_TARGET != HWY_SCALAR
  const bool is_slow =
      std::abs(s.x_poly[1] - 1) + std::abs(s.y_poly[1]) < kRareRun && pixels.has_runs();
  if (is_slow)
    for (; i + kGroup <= count; i += kGroup) {
      if (kOneByOne) fetch_ahead(i, i + kGroup);
      pixels.AddGroup(i, starts + i);
    }
  for (; i + kGroup <= count; i += kGroup) {
    if (kOneByOne) fetch_ahead(i, i + kGroup);
    for (int k = i; k < i + kGroup; ++k) pixels.Add(k, starts[k]);
  }
#endif
  for (; i < count; ++i) pixels.Add(i, starts[i]);
  return pixels.CountRays(count);
}

// Adds the rays of `plan` that land in tile `tile` to `sums`. Returns the number of rays.
//   most_weight  the largest of the weights
template <class Weights>
HWY_ATTR uint64_t ScatterTileBy(const ScatterPlan& plan, size_t tile, const LfPixels& pixels,
                                const Weights& weights, uint32_t most_weight, TileSums* sums) {
  const bool is_rgb = pixels.bayer == BayerPattern::kNone;
  const int stride = sums->stride();
  const PixelRect& rect = sums->rect();
  const bool has_plate_border = rect.x_begin == 0 || rect.y_begin == 0 ||
                                rect.x_end == plan.grid.plate_width ||
                                rect.y_end == plan.grid.plate_height;
  const TileLayout layout{rect, is_rgb ? stride : TileSums::kMosaicRows * stride, has_plate_border};
  // If more rays than this may hit the same element, a piece is added in several parts, so that
  // sums do not overflow.
  const uint32_t most_rays = sums->max_reserve() / most_weight;
  uint64_t rays = 0;
  const TilePiece* piece = plan.pieces.begin(tile);
  for (int begin = 0; piece != plan.pieces.end(tile);) {
    TilePiece part = *piece;
    part.begin = static_cast<uint16_t>(part.begin + begin);
    if (HWY_UNLIKELY(part.crowd > most_rays)) {
      part.crowd = static_cast<uint16_t>(std::min<uint32_t>(part.end - part.begin, most_rays));
      part.end = static_cast<uint16_t>(part.begin + part.crowd);
    }
    const Segment& s = plan.segments[part.segment];
    const int row = s.y - pixels.rect.y_begin;
    const int column = s.x_begin + part.begin - pixels.rect.x_begin;
    constexpr int kRowsAhead = 4;
    const int row_ahead = std::min(row + kRowsAhead, pixels.rect.height() - 1);
    if (is_rgb) {
      const ptrdiff_t lane = static_cast<ptrdiff_t>(column) * LfPixels::kRgbLanes;
      rays +=
          ScatterPiece(s, part,
                       RgbPixels<Weights>{
                           pixels.radiance.row(row) + lane, pixels.radiance.row(row_ahead) + lane,
                           sums->ReserveRgb(part.crowd * most_weight), weights, pixels.any_masked},
                       layout);
    } else {
      // `first` is the colour (0 R, 1 G, 2 B) of the first pixel of the piece, `other` the colour
      // that alternates with green in this scanline.
      const int x = s.x_begin + part.begin;
      const int first = BayerChannel(pixels.bayer, x, s.y);
      const int other = first == 1 ? BayerChannel(pixels.bayer, x + 1, s.y) : first;
      uint64_t* const words =
          sums->ReserveMosaic(part.crowd * most_weight) +
          static_cast<ptrdiff_t>(other == 2 ? TileSums::kBlueFirst : 0) * stride;
      uint64_t* const other_words = words + static_cast<ptrdiff_t>(TileSums::kGreenFirst) * stride;
      rays += ScatterPiece(
          s, part,
          MosaicPixels<Weights>{
              pixels.radiance.row(row) + column,
              pixels.radiance.row(row_ahead) + column,
              {first == 1 ? other_words : words, first == 1 ? words : other_words},
              weights,
              pixels.mosaic_mask.empty() ? nullptr : pixels.mosaic_mask.row(row) + column},
          layout);
    }
    const bool is_last = part.end == piece->end;
    begin = is_last ? 0 : part.end - piece->begin;
    piece += is_last ? 1 : 0;
  }
  return rays;
}

HWY_ATTR uint64_t ScatterTile(const ScatterPlan& plan, size_t tile, const LfPixels& pixels,
                              const TileWeights& weights, TileSums* sums) {
  const uint32_t most = weights.most();
  if (weights.least() < most)
    return ScatterTileBy(plan, tile, pixels, WeightByElement{weights.data()}, most, sums);
  if (most > 1) return ScatterTileBy(plan, tile, pixels, WeightSame{most}, most, sums);
  return ScatterTileBy(plan, tile, pixels, WeightOne(), 1, sums);
}

}  // namespace HWY_NAMESPACE
}  // namespace lf
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lf {
HWY_EXPORT(ScatterTile);

uint64_t ScatterTile(const ScatterPlan& plan, size_t tile, const LfPixels& pixels, TileSums* sums,
                     const RayWeights& weights) {
  const PixelRect& rect = sums->rect();
  LF_CHECK(plan.grid.RectOf(tile) == rect);
  // This limit makes addresses in the tile, and addresses counted from the base of a segment, exact
  // in single precision.
  const int64_t row_stride = int64_t{TileSums::kMosaicRows} * sums->stride();
  LF_CHECK(row_stride * (rect.height() + int64_t{Segment::kMaxCount}) < (int64_t{1} << 22));
  if (plan.pieces.begin(tile) == plan.pieces.end(tile)) return 0;
  thread_local TileWeights tile_weights;
  const bool is_rgb = pixels.bayer == BayerPattern::kNone;
  tile_weights.Fill(weights, rect, rect, is_rgb ? sums->stride() : static_cast<int>(row_stride));
  if (tile_weights.most() == 0) return 0;
  return HWY_DYNAMIC_DISPATCH(ScatterTile)(plan, tile, pixels, tile_weights, sums);
}

}  // namespace lf
#endif
