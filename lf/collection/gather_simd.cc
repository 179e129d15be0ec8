// The inner loop of the estimator *bilinear*, for every instruction set from one source (Highway):
// positions by cubics, a vector at a time; then four pixels, each four lanes of 16 bits, are mixed
// in integers and added to the element. No fused multiply-add: the same bits on every target.
#include <algorithm>

#include "lf/collection/gather.h"
#include "lf/core/check.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lf/collection/gather_simd.cc"  // NOLINT: as Highway wants it
#include <hwy/foreach_target.h>
// After foreach_target.h.
#include <hwy/cache_control.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lf {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using LaneF = hn::CappedTag<float, 16>;
using LaneI = hn::RebindToSigned<LaneF>;
constexpr int kLanes = static_cast<int>(hn::MaxLanes(LaneF()));

constexpr uint32_t kOne = 256;  // of the weights

// Upper left pixels of consecutive elements, and the weights of the right, upper and lower ones.
struct Places {
  HWY_ALIGN int32_t pixel[CubicSegment::kMaxCount];
  HWY_ALIGN uint32_t right[CubicSegment::kMaxCount];
  HWY_ALIGN uint32_t upper[CubicSegment::kMaxCount];
  HWY_ALIGN uint32_t lower[CubicSegment::kMaxCount];
};

// One coordinate: the pixel before the position, and its distance in 1/256.
struct Coordinate {
  hn::Vec<LaneI> pixel;
  hn::Vec<LaneI> weight;
};
// Within pixels [begin, end).
HWY_ATTR HWY_INLINE Coordinate FindCoordinate(const float (&c)[4], int32_t base, int begin, int end,
                                              hn::Vec<LaneF> t) {
  const LaneF df;
  const LaneI di;
  const auto half = hn::Set(df, 0.5F);
  const auto cubic =
      hn::Add(hn::Mul(hn::Add(hn::Mul(hn::Add(hn::Mul(hn::Set(df, c[3]), t), hn::Set(df, c[2])), t),
                              hn::Set(df, c[1])),
                      t),
              hn::Set(df, c[0]));
  // From pixel centres; what rounding has sent beyond the pixels is on their border.
  const auto position =
      hn::Min(hn::Max(hn::Sub(cubic, half), hn::Set(df, static_cast<float>(begin - base))),
              hn::Set(df, static_cast<float>(end - 1 - base)));
  const auto pixel = hn::Min(hn::Floor(position), hn::Set(df, static_cast<float>(end - 2 - base)));
  const auto weight = hn::Floor(
      hn::Add(hn::Mul(hn::Sub(position, pixel), hn::Set(df, static_cast<float>(kOne))), half));
  return {hn::Add(hn::ConvertTo(di, pixel), hn::Set(di, base)), hn::ConvertTo(di, weight)};
}

HWY_ATTR void FindPlaces(const CubicSegment& s, int begin, int count, const PixelRect& rect,
                         Places* places) {
  const LaneF df;
  const LaneI di;
  const auto width = hn::Set(di, rect.width());
  const auto x_begin = hn::Set(di, rect.x_begin), y_begin = hn::Set(di, rect.y_begin);
  for (int i = 0; i < count; i += kLanes) {
    const auto t = hn::Iota(df, s.t_begin + static_cast<float>(begin + i));
    const Coordinate x = FindCoordinate(s.x_cubic, s.base_x, rect.x_begin, rect.x_end, t);
    const Coordinate y = FindCoordinate(s.y_cubic, s.base_y, rect.y_begin, rect.y_end, t);
    const auto row = hn::Sub(y.pixel, y_begin), column = hn::Sub(x.pixel, x_begin);
    hn::Store(hn::Add(hn::Mul(row, width), column), di, places->pixel + i);
    const hn::RebindToUnsigned<LaneI> du;
    const auto weight = hn::BitCast(du, y.weight);
    hn::Store(hn::BitCast(du, x.weight), du, places->right + i);
    hn::Store(hn::Sub(hn::Set(du, kOne), weight), du, places->upper + i);
    hn::Store(weight, du, places->lower + i);
  }
}

// Sums of 65535 * 65536 and the half that rounds just fit into 32 bits.
constexpr uint32_t kHalf = kOne * kOne / 2;

#if HWY_TARGET == HWY_SCALAR

HWY_INLINE void AddRay(const uint16_t* upper, const uint16_t* lower, uint32_t right_weight,
                       uint32_t above, uint32_t lower_weight, uint32_t* sums) {
  const uint32_t left = kOne - right_weight;
  for (int lane = 0; lane < LfPixels::kRgbLanes; ++lane) {
    const int next = lane + LfPixels::kRgbLanes;
    const uint32_t sum = upper[lane] * (left * above) + upper[next] * (right_weight * above) +
                         lower[lane] * (left * lower_weight) +
                         lower[next] * (right_weight * lower_weight);
    sums[lane] += (sum + kHalf) >> 16;
  }
}

#elif HWY_MAX_BYTES >= 32

// Weights of the left and of the right pixel, four lanes each.
struct alignas(32) ColumnWeights {
  uint32_t lanes[2 * LfPixels::kRgbLanes];
};
struct ColumnWeightTable {
  ColumnWeights of_right[kOne + 1];
  constexpr ColumnWeightTable() : of_right() {
    for (uint32_t right = 0; right <= kOne; ++right)
      for (int lane = 0; lane < LfPixels::kRgbLanes; ++lane) {
        of_right[right].lanes[lane] = kOne - right;
        of_right[right].lanes[lane + LfPixels::kRgbLanes] = right;
      }
  }
};
constexpr ColumnWeightTable kColumnWeights;

// Two pixels at a time: first the rows are mixed, then the columns.
HWY_ATTR HWY_INLINE void AddRay(const uint16_t* upper, const uint16_t* lower, uint32_t right_weight,
                                uint32_t above, uint32_t lower_weight, uint32_t* sums) {
  const hn::FixedTag<uint32_t, 8> d32;
  const hn::FixedTag<uint16_t, 8> d16;
  const hn::Full128<uint32_t> half;
  const auto rows =
      hn::Add(hn::Mul(hn::PromoteTo(d32, hn::LoadU(d16, upper)), hn::Set(d32, above)),
              hn::Mul(hn::PromoteTo(d32, hn::LoadU(d16, lower)), hn::Set(d32, lower_weight)));
  const auto columns = hn::Mul(rows, hn::Load(d32, kColumnWeights.of_right[right_weight].lanes));
  const auto sum = hn::Add(hn::LowerHalf(half, columns), hn::UpperHalf(half, columns));
  const auto ray = hn::ShiftRight<16>(hn::Add(sum, hn::Set(half, kHalf)));
  hn::Store(hn::Add(hn::Load(half, sums), ray), half, sums);
}

#else

HWY_ATTR HWY_INLINE void AddRay(const uint16_t* upper, const uint16_t* lower, uint32_t right_weight,
                                uint32_t above, uint32_t lower_weight, uint32_t* sums) {
  const hn::Full128<uint32_t> d32;
  const hn::Full64<uint16_t> d16;
  const uint32_t left = kOne - right_weight;
  const auto part = [&](const uint16_t* pixel, uint32_t weight) HWY_ATTR {
    return hn::Mul(hn::PromoteTo(d32, hn::LoadU(d16, pixel)), hn::Set(d32, weight));
  };
  const auto sum = hn::Add(
      hn::Add(part(upper, left * above), part(upper + LfPixels::kRgbLanes, right_weight * above)),
      hn::Add(part(lower, left * lower_weight),
              part(lower + LfPixels::kRgbLanes, right_weight * lower_weight)));
  const auto ray = hn::ShiftRight<16>(hn::Add(sum, hn::Set(d32, kHalf)));
  hn::Store(hn::Add(hn::Load(d32, sums), ray), d32, sums);
}

#endif

// Elements [begin, begin + count) of the segment; `sums` of the first.
template <bool kMayBeMasked>
HWY_ATTR uint32_t GatherPart(const CubicSegment& s, int begin, int count, const LfPixels& pixels,
                             TileSums::Element* sums) {
  Places places;
  FindPlaces(s, begin, count, pixels.rect, &places);
  const uint16_t* const values = pixels.radiance.row(0);
  const ptrdiff_t row_values = static_cast<ptrdiff_t>(pixels.rect.width()) * LfPixels::kRgbLanes;
  constexpr int kRowsAhead = 2;
  constexpr int kLineElements = 8;  // of an LF image, in a cache line
  uint32_t rays = 0;
  for (int i = 0; i < count; ++i) {
    const uint16_t* upper = values + static_cast<ptrdiff_t>(places.pixel[i]) * LfPixels::kRgbLanes;
    const uint16_t* lower = upper + row_values;
    // Rows are too far apart for the processor to foresee.
    if (i % kLineElements == 0) hwy::Prefetch(lower + kRowsAhead * row_values);
    LF_DCHECK(places.pixel[i] >= 0 &&
              lower + 2 * LfPixels::kRgbLanes <= values + pixels.radiance.pixels().size());
    if constexpr (kMayBeMasked) {
      constexpr int kRay = LfPixels::kRayLane, kNext = kRay + LfPixels::kRgbLanes;
      if (upper[kRay] + upper[kNext] + lower[kRay] + lower[kNext] != 4) continue;
    }
    AddRay(upper, lower, places.right[i], places.upper[i], places.lower[i], sums[i].rgb_rays);
    ++rays;
  }
  return rays;
}

HWY_ATTR uint64_t GatherTile(const GatherPlan& plan, const LfPixels& pixels, TileSums* sums) {
  TileSums::Element* const elements = sums->ReserveRgb(1);  // at most one ray for each
  const PixelRect& tile = sums->rect();
  uint64_t rays = 0;
  for (int y = tile.y_begin; y < tile.y_end; ++y) {
    TileSums::Element* const row =
        elements + static_cast<ptrdiff_t>(y - tile.y_begin) * sums->stride();
    for (size_t i = plan.row_begin[y]; i < plan.row_begin[y + 1]; ++i) {
      const CubicSegment& s = plan.segments[i];
      const int begin = std::max(s.x_begin, tile.x_begin);
      const int end = std::min(s.x_begin + s.count, tile.x_end);
      if (begin >= end) continue;
      const auto gather = pixels.any_masked ? GatherPart<true> : GatherPart<false>;
      rays += gather(s, begin - s.x_begin, end - begin, pixels, row + (begin - tile.x_begin));
    }
  }
  return rays;
}

}  // namespace HWY_NAMESPACE
}  // namespace lf
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lf {
HWY_EXPORT(GatherTile);

uint64_t GatherTile(const GatherPlan& plan, const LfPixels& pixels, TileSums* sums) {
  LF_CHECK(pixels.bayer == BayerPattern::kNone);
  LF_CHECK(sums->rect().x_end <= plan.plate_width && sums->rect().y_end <= plan.plate_height);
  if (plan.segments.empty()) return 0;
  LF_CHECK(pixels.rect.width() >= 2 && pixels.rect.height() >= 2);
  return HWY_DYNAMIC_DISPATCH(GatherTile)(plan, pixels, sums);
}

}  // namespace lf
#endif
