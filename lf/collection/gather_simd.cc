// The inner loop of the estimator *bilinear*, for every instruction set from one source (Highway):
// positions by polynomials, a vector at a time; then four or sixteen pixels, each four lanes of 16
// bits, are mixed in integers and added to the element. No fused multiply-add: the same bits on
// every target.
#include <algorithm>
#include <bit>
#include <cstring>
#include <vector>

#include "lf/collection/gather.h"
#include "lf/collection/tile_weights.h"
#include "lf/core/check.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lf/collection/gather_simd.cc"  // NOLINT: as Highway wants it
#include <hwy/foreach_target.h>
// After foreach_target.h.
#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include "lf/collection/cubic_simd-inl.h"
#include "lf/collection/polynomial_simd-inl.h"
#include "lf/collection/ray_weight_simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lf {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr int kWeightBits = 8;
constexpr int kOne = 1 << kWeightBits;  // of the weights

// Upper left pixels of consecutive elements, and the weights of the others.
struct Places {
  static constexpr int kRoom = Segment::kMaxCount + kLanes;
  HWY_ALIGN int32_t pixel[kRoom];
  HWY_ALIGN uint32_t left_right[kRoom];  // those of the left and of the right pixels, 16 bits each
  HWY_ALIGN uint32_t lower[kRoom];
};

// Integers below 2^22 of either sign are exact in single precision; added to 2^23 + 2^22 they are
// its last bits: cheaper than a conversion, which minds overflow.
constexpr float kWhole = 12582912;

// One coordinate: the pixel before the position, counted from `begin`, and its distance in 1/256.
struct Coordinate {
  hn::Vec<LaneI> pixel;
  hn::Vec<LaneI> weight;
};

// Finds it within pixels [begin, end).
template <int kDegree>
class CoordinateFinder {
 public:
  HWY_ATTR HWY_INLINE CoordinateFinder(const float (&polynomial)[Segment::kTerms], int32_t base,
                                       int begin, int end)
      : base_((base - begin) * kOne - std::bit_cast<int32_t>(kWhole)), last_(end - begin - 1) {
    // In 1/256 from the centre of pixel `begin`, rounded half up; multiplying by 256 is exact.
    for (int power = 0; power < Segment::kTerms; ++power)
      polynomial_[power] = polynomial[power] * kOne;
    polynomial_[0] += 0.5F - 0.5F * kOne;
  }

  HWY_ATTR HWY_INLINE Coordinate Find(hn::Vec<LaneF> t) const {
    const LaneI di;
    const auto place = PolynomialLanes<kDegree>(polynomial_).At(t);
    const auto whole = hn::BitCast(di, hn::Add(hn::Floor(place), hn::Set(LaneF(), kWhole)));
    const auto found = hn::Add(whole, hn::Set(di, base_));
    // What rounding has sent beyond the pixels is on their border.
    const auto position = hn::Min(hn::Max(found, hn::Zero(di)), hn::Set(di, last_ * kOne));
    const auto pixel = hn::Min(hn::ShiftRight<kWeightBits>(position), hn::Set(di, last_ - 1));
    return {pixel, hn::Sub(position, hn::ShiftLeft<kWeightBits>(pixel))};
  }

 private:
  float polynomial_[Segment::kTerms];
  int32_t base_;  // less the bits of kWhole
  int32_t last_;
};

template <int kDegree>
HWY_ATTR void FindPlaces(const Segment& s, int begin, int count, const PixelRect& rect,
                         PixelFilter filter, Places* places) {
  const LaneF df;
  const LaneI di;
  const hn::RebindToUnsigned<LaneI> du;
  const CoordinateFinder<kDegree> x_finder(s.x_poly, s.base_x, rect.x_begin, rect.x_end);
  const CoordinateFinder<kDegree> y_finder(s.y_poly, s.base_y, rect.y_begin, rect.y_end);
  const auto width = hn::Set(di, rect.width());
  // Added before the weight is cut to kOne or 0.
  const bool is_nearest = filter == PixelFilter::kNearest;
  const auto half = hn::Set(di, is_nearest ? kOne / 2 : 0);
  const auto kept_bits = hn::Set(di, is_nearest ? kOne : -1);
  const auto weight_of = [&](hn::Vec<LaneI> weight)
                             HWY_ATTR { return hn::And(hn::Add(weight, half), kept_bits); };
  auto t = hn::Iota(df, s.t_begin + static_cast<float>(begin));
  for (int i = 0; i < count; i += kLanes, t = hn::Add(t, hn::Set(df, kLanes))) {
    const Coordinate x = x_finder.Find(t), y = y_finder.Find(t);
    hn::Store(hn::Add(hn::Mul(y.pixel, width), x.pixel), di, places->pixel + i);
    const auto right_weight = weight_of(x.weight);
    const auto left_weight = hn::Sub(hn::Set(di, kOne), right_weight);
    hn::Store(hn::BitCast(du, hn::Or(left_weight, hn::ShiftLeft<16>(right_weight))), du,
              places->left_right + i);
    hn::Store(hn::BitCast(du, weight_of(y.weight)), du, places->lower + i);
  }
}

// Sums of 65535 * 65536 and the half that rounds just fit into 32 bits.
constexpr uint32_t kHalf = kOne * kOne / 2;

// Weights and sums are those of the elements from the first one on.
#if HWY_TARGET == HWY_SCALAR

constexpr int kRaysAtOnce = 1;

template <class Weights>
HWY_INLINE void AddRays(const Places& places, int i, const uint16_t* values, ptrdiff_t row_values,
                        const Weights& weights, TileSums::Element* sums) {
  const uint16_t* upper = values + static_cast<ptrdiff_t>(places.pixel[i]) * LfPixels::kRgbLanes;
  const uint16_t* lower = upper + row_values;
  const uint32_t right = places.left_right[i] >> 16, left = kOne - right, down = places.lower[i];
  for (int lane = 0; lane < LfPixels::kRgbLanes; ++lane) {
    const int next = lane + LfPixels::kRgbLanes;
    const uint32_t sum = (upper[lane] * left + upper[next] * right) * (kOne - down) +
                         (lower[lane] * left + lower[next] * right) * down;
    sums[i].rgb_rays[lane] += ((sum + kHalf) >> (2 * kWeightBits)) * weights.At(i);
  }
}
template <class Weights>
constexpr auto AddRay = AddRays<Weights>;

#else

using AllLanes = hn::CappedTag<uint32_t, 16>;
using LanesOfOne = hn::Full128<uint32_t>;
constexpr int kRaysAtOnce = static_cast<int>(hn::MaxLanes(AllLanes())) / LfPixels::kRgbLanes;

// Two pixels side by side for each ray, in a block of 128 bits.
HWY_ATTR HWY_INLINE hn::Vec<hn::Full128<uint16_t>> LoadPairs(hn::Full128<uint16_t> d,
                                                             const uint16_t* values,
                                                             const int32_t* pixel) {
  return hn::LoadU(d, values + static_cast<ptrdiff_t>(pixel[0]) * LfPixels::kRgbLanes);
}
template <class D>
HWY_ATTR HWY_INLINE hn::Vec<D> LoadPairs(D d, const uint16_t* values, const int32_t* pixel) {
  const hn::Half<D> half;
  constexpr int kBlocks = static_cast<int>(hn::MaxLanes(half)) * 2 / 16;
  return hn::Combine(d, LoadPairs(half, values, pixel + kBlocks), LoadPairs(half, values, pixel));
}

// weights[k] in all lanes of block k.
template <class D>
HWY_ATTR HWY_INLINE hn::Vec<D> LoadWeights(D d, const uint32_t* weights) {
  if constexpr (hn::MaxLanes(d) == 4) {
    return hn::Set(d, *weights);
  } else {
    HWY_ALIGN static constexpr uint8_t kBytes[64] = {
        0,  1,  2,  3,  0,  1,  2,  3,  0,  1,  2,  3,  0,  1,  2,  3,   //
        4,  5,  6,  7,  4,  5,  6,  7,  4,  5,  6,  7,  4,  5,  6,  7,   //
        8,  9,  10, 11, 8,  9,  10, 11, 8,  9,  10, 11, 8,  9,  10, 11,  //
        12, 13, 14, 15, 12, 13, 14, 15, 12, 13, 14, 15, 12, 13, 14, 15};
    const hn::Repartition<uint8_t, D> d8;
    return hn::BitCast(
        d, hn::TableLookupBytes(hn::BitCast(d8, hn::LoadDup128(d, weights)), hn::Load(d8, kBytes)));
  }
}

// first * (256 - weight) + second * weight, modulo 2^32.
template <class V>
HWY_ATTR HWY_INLINE V Mix(V first, V second, V weight) {
  return hn::Add(hn::ShiftLeft<kWeightBits>(first), hn::Mul(hn::Sub(second, first), weight));
}

// Of as many rays, from `i` on, as there are blocks in the vector.
template <class D, class Weights>
HWY_ATTR HWY_INLINE void AddRaysOf(D d, const Places& places, int i, const uint16_t* values,
                                   ptrdiff_t row_values, const Weights& weights,
                                   TileSums::Element* sums) {
  const hn::Repartition<uint16_t, D> d16;
  const hn::Repartition<uint8_t, D> d8;
  const hn::RebindToSigned<D> di;
  const hn::RebindToSigned<decltype(d16)> di16;
  // Of each colour, the left and the right pixel side by side.
  HWY_ALIGN static constexpr uint8_t kSideBySide[16] = {0, 1, 8,  9,  2, 3, 10, 11,
                                                        4, 5, 12, 13, 6, 7, 14, 15};
  const auto side_by_side = hn::LoadDup128(d8, kSideBySide);
  const auto middle = hn::Set(d16, kMiddle);
  const auto left_right = hn::BitCast(di16, LoadWeights(d, places.left_right + i));
  const auto mix_row = [&](const uint16_t* row) HWY_ATTR {
    const auto pairs = LoadPairs(d16, row, places.pixel + i);
    const auto mixed = hn::BitCast(d16, hn::TableLookupBytes(hn::BitCast(d8, pairs), side_by_side));
    const auto about_0 = hn::BitCast(di16, hn::Xor(mixed, middle));
    auto odd = hn::Zero(di);
    const auto even = hn::ReorderWidenMulAccumulate(di, about_0, left_right, hn::Zero(di), odd);
    return hn::BitCast(d, hn::RearrangeToOddPlusEven(even, odd));
  };
  const auto sum =
      Mix(mix_row(values), mix_row(values + row_values), LoadWeights(d, places.lower + i));
  // All weights together, 65536, times kMiddle make the highest bit.
  constexpr uint32_t kBack = uint32_t{kMiddle} * kOne * kOne + kHalf;
  auto rays = hn::ShiftRight<2 * kWeightBits>(hn::Add(sum, hn::Set(d, kBack)));
  if constexpr (!Weights::kIsOne) rays = hn::Mul(rays, weights.OfPixels(d, i));
  uint32_t* const lanes = sums[i].rgb_rays;
  hn::StoreU(hn::Add(hn::LoadU(d, lanes), rays), d, lanes);
}

template <class Weights>
HWY_ATTR HWY_INLINE void AddRays(const Places& places, int i, const uint16_t* values,
                                 ptrdiff_t row_values, const Weights& weights,
                                 TileSums::Element* sums) {
  AddRaysOf(AllLanes(), places, i, values, row_values, weights, sums);
}
template <class Weights>
HWY_ATTR HWY_INLINE void AddRay(const Places& places, int i, const uint16_t* values,
                                ptrdiff_t row_values, const Weights& weights,
                                TileSums::Element* sums) {
  AddRaysOf(LanesOfOne(), places, i, values, row_values, weights, sums);
}

#endif

// Whether all rays are so far from the border of the pixels that these hold the sixteen around
// each.
bool IsInner(const Segment& s, int begin, int count, const PixelRect& rect) {
  const float t = s.t_begin + static_cast<float>(begin);
  const auto is_inner = [](const PositionRange& range, int base, int pixel_begin, int pixel_end) {
    constexpr float kBorder = 1.51F;
    return static_cast<float>(base - pixel_begin) + range.low >= kBorder &&
           static_cast<float>(base - pixel_end) + range.high <= -kBorder;
  };
  return is_inner(RangeOf(s.x_poly, t, count), s.base_x, rect.x_begin, rect.x_end) &&
         is_inner(RangeOf(s.y_poly, t, count), s.base_y, rect.y_begin, rect.y_end);
}

// Elements [begin, begin + count) of the segment; weights and sums from the first one on.
template <bool kMayBeMasked, bool kIsCubic, class Weights>
HWY_ATTR uint32_t GatherPart(const Segment& s, int begin, int count, PixelFilter filter,
                             const LfPixels& pixels, const Weights& weights,
                             TileSums::Element* sums) {
  Places places;
  const auto find_places = s.is_cubic() ? FindPlaces<3> : FindPlaces<5>;
  find_places(s, begin, count, pixels.rect, filter, &places);
  const uint16_t* const values = pixels.radiance.row(0);
  const ptrdiff_t row_values = static_cast<ptrdiff_t>(pixels.rect.width()) * LfPixels::kRgbLanes;
  const auto upper = [&](int i) {
    LF_DCHECK(places.pixel[i] >= 0 &&
              places.pixel[i] < pixels.rect.width() * (pixels.rect.height() - 1) - 1);
    return values + static_cast<ptrdiff_t>(places.pixel[i]) * LfPixels::kRgbLanes;
  };
  const auto add_cubic_ray = [&](int i) HWY_ATTR {
    AddCubicRay(TablesOfCubics(), places.left_right[i] >> 16, places.lower[i],
                upper(i) - row_values - LfPixels::kRgbLanes, row_values, weights, i, sums);
  };
  // Rows are too far apart for the processor to foresee, and it waits for few lines at a time: they
  // are asked for one by one.
  constexpr int kRowsAhead = 2;
  constexpr int kLineElements = 8;  // of an LF image, in a cache line
  const auto fetch_ahead = [&](int i) { hwy::Prefetch(upper(i) + (1 + kRowsAhead) * row_values); };
  if (kMayBeMasked || (kIsCubic && !IsInner(s, begin, count, pixels.rect))) {
    const auto has_all = [&](int i, int outer) {
      const int x = places.pixel[i] % pixels.rect.width(),
                y = places.pixel[i] / pixels.rect.width();
      if (x < outer || x + 1 + outer >= pixels.rect.width() || y < outer ||
          y + 1 + outer >= pixels.rect.height())
        return false;
      const int taps = 2 + 2 * outer;
      const uint16_t* const ray =
          upper(i) - outer * (row_values + LfPixels::kRgbLanes) + LfPixels::kRayLane;
      int unmasked = 0;
      for (int tap = 0; tap < taps * taps; ++tap)
        unmasked += ray[tap / taps * row_values + tap % taps * LfPixels::kRgbLanes];
      return unmasked == taps * taps;
    };
    uint32_t rays = 0;
    for (int i = 0; i < count; ++i) {
      if (i % kLineElements == 0) fetch_ahead(i);
      if (kIsCubic && has_all(i, 1))
        add_cubic_ray(i);
      else if (has_all(i, 0))
        AddRay<Weights>(places, i, values, row_values, weights, sums);
      else
        continue;
      ++rays;
    }
    return rays;
  }
  int i = 0;
  for (; i + kLineElements <= count; i += kLineElements) {
    fetch_ahead(i);
    if constexpr (kIsCubic)
      for (int k = i; k < i + kLineElements; ++k) add_cubic_ray(k);
    else
      for (int k = i; k < i + kLineElements; k += kRaysAtOnce)
        AddRays(places, k, values, row_values, weights, sums);
  }
  for (; i < count; ++i) {
    if constexpr (kIsCubic)
      add_cubic_ray(i);
    else
      AddRay<Weights>(places, i, values, row_values, weights, sums);
  }
  return static_cast<uint32_t>(count);
}

template <class Weights>
auto GatherPartOf(const LfPixels& pixels, PixelFilter filter) {
  if (filter == PixelFilter::kBicubic)
    return pixels.any_masked ? GatherPart<true, true, Weights> : GatherPart<false, true, Weights>;
  return pixels.any_masked ? GatherPart<true, false, Weights> : GatherPart<false, false, Weights>;
}

// One ray an element.
//   most_weight  of the weights
template <class Weights>
HWY_ATTR uint64_t GatherTileBy(const GatherPlan& plan, const LfPixels& pixels,
                               const Weights& weights, uint32_t most_weight, TileSums* sums) {
  TileSums::Element* const elements = sums->ReserveRgb(most_weight);  // at most one ray for each
  const PixelRect& tile = sums->rect();
  const auto gather = GatherPartOf<Weights>(pixels, plan.sampling.filter);
  uint64_t rays = 0;
  for (int y = tile.y_begin; y < tile.y_end; ++y) {
    const ptrdiff_t row = static_cast<ptrdiff_t>(y - tile.y_begin) * sums->stride();
    for (size_t i = plan.row_begin[y]; i < plan.row_begin[y + 1]; ++i) {
      const Segment& s = plan.segments[i];
      const int begin = std::max(s.x_begin, tile.x_begin);
      const int end = std::min(s.x_begin + s.count, tile.x_end);
      if (begin >= end) continue;
      const ptrdiff_t element = row + (begin - tile.x_begin);
      rays += gather(s, begin - s.x_begin, end - begin, plan.sampling.filter, pixels,
                     weights.From(element), elements + element);
    }
  }
  return rays;
}

// Adds the means of a row of elements, rounded half up, each of the up to samples^2 rays that are
// added up on as many elements of `fine`. Returns how many.
//
// Quotients of numbers up to 2^24 are rounded down rightly: those next to an integer are further
// from it than a float can tell.
#if HWY_TARGET == HWY_SCALAR

template <class Weights>
uint64_t AddMeans(const TileSums::Element* fine, int samples, int count, const Weights& weights,
                  TileSums::Element* sums) {
  uint64_t rays = 0;
  for (int i = 0; i < count; ++i, fine += samples) {
    TileSums::Element sum;
    for (int k = 0; k < samples; ++k)
      for (int lane = 0; lane < LfPixels::kRgbLanes; ++lane)
        sum.rgb_rays[lane] += fine[k].rgb_rays[lane];
    const uint32_t added = sum.rgb_rays[LfPixels::kRayLane];
    if (added == 0) continue;
    for (int lane = 0; lane < LfPixels::kRgbLanes; ++lane)
      sums[i].rgb_rays[lane] += (sum.rgb_rays[lane] + added / 2) / added * weights.At(i);
    ++rays;
  }
  return rays;
}

#else

template <class Weights>
HWY_ATTR uint64_t AddMeans(const TileSums::Element* fine, int samples, int count,
                           const Weights& weights, TileSums::Element* sums) {
  const hn::Full128<uint32_t> du;
  const hn::Full128<int32_t> di;
  const hn::Full128<float> df;
  auto rays = hn::Zero(di);  // in the lane of rays
  for (int i = 0; i < count; ++i, fine += samples) {
    auto sum = hn::Load(du, fine[0].rgb_rays);
    for (int k = 1; k < samples; ++k) sum = hn::Add(sum, hn::Load(du, fine[k].rgb_rays));
    const auto rays_and_sums = hn::BitCast(di, sum);
    const auto added = hn::Broadcast<LfPixels::kRayLane>(rays_and_sums);
    const auto dividend = hn::Add(rays_and_sums, hn::ShiftRight<1>(added));
    // Where none is added all lanes are 0.
    const auto divisor = hn::Max(added, hn::Set(di, 1));
    auto mean = hn::ConvertTo(di, hn::Div(hn::ConvertTo(df, dividend), hn::ConvertTo(df, divisor)));
    rays = hn::Add(rays, mean);
    if constexpr (!Weights::kIsOne) mean = hn::Mul(mean, hn::BitCast(di, weights.OfPixels(du, i)));
    uint32_t* const lanes = sums[i].rgb_rays;
    hn::Store(hn::Add(hn::Load(du, lanes), hn::BitCast(du, mean)), du, lanes);
  }
  return static_cast<uint64_t>(hn::ExtractLane(rays, LfPixels::kRayLane));
}

#endif

// The mean of several rays an element: those of a row of elements are added up on a row as fine as
// they are.
template <class Weights>
HWY_ATTR uint64_t GatherFinely(const GatherPlan& plan, const LfPixels& pixels,
                               const Weights& weights, uint32_t most_weight, TileSums* sums) {
  TileSums::Element* const elements = sums->ReserveRgb(most_weight);
  const PixelRect& tile = sums->rect();
  const auto gather = GatherPartOf<WeightOne>(pixels, plan.sampling.filter);
  const int samples = plan.sampling.samples;
  thread_local std::vector<TileSums::Element> fine;
  uint64_t rays = 0;
  // So few that the fine row and its places stay in the first level cache.
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
        gather(s, begin - s.x_begin, end - begin, plan.sampling.filter, pixels, WeightOne(),
               fine.data() + (begin - fine_begin));
      }
      if (!any) continue;
      const ptrdiff_t element =
          static_cast<ptrdiff_t>(y - tile.y_begin) * sums->stride() + (x_begin - tile.x_begin);
      rays += AddMeans(fine.data(), samples, x_end - x_begin, weights.From(element),
                       elements + element);
    }
  }
  return rays;
}

template <class Weights>
HWY_ATTR uint64_t GatherBy(const GatherPlan& plan, const LfPixels& pixels, const Weights& weights,
                           uint32_t most_weight, TileSums* sums) {
  const auto gather = plan.sampling.samples == 1 ? GatherTileBy<Weights> : GatherFinely<Weights>;
  return gather(plan, pixels, weights, most_weight, sums);
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

uint64_t GatherTile(const GatherPlan& plan, const LfPixels& pixels, TileSums* sums,
                    const RayWeights& weights) {
  LF_CHECK(pixels.bayer == BayerPattern::kNone);
  LF_CHECK(sums->rect().x_end <= plan.plate_width && sums->rect().y_end <= plan.plate_height);
  if (plan.segments.empty()) return 0;
  LF_CHECK(pixels.rect.width() >= 2 && pixels.rect.height() >= 2);
  thread_local TileWeights tile_weights;
  tile_weights.Fill(weights, sums->rect(), sums->stride());
  if (tile_weights.most() == 0) return 0;
  return HWY_DYNAMIC_DISPATCH(GatherTile)(plan, pixels, tile_weights, sums);
}

}  // namespace lf
#endif
