// SPDX-License-Identifier: Apache-2.0
// Compiled for every instruction set from one source (Highway). All arithmetic is of integers, so
// that results are bit-identical. A vector holds one to four pixels of four lanes.
#include "lf/collection/prefilter/prefilter_rows.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE \
  "lf/collection/prefilter/prefilter_rows.cc"  // NOLINT: as Highway wants it
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lf {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr ptrdiff_t kLanes = LfPixels::kRgbLanes;
constexpr int kRowShift = Prefilter::kBits - kPrefilterFraction;
constexpr int kColumnShift = Prefilter::kBits + kPrefilterFraction;

#if HWY_TARGET == HWY_SCALAR

// Returns the value of a knot in `lane`, times Prefilter::kOne; 0 if it is masked. at(k, lane) is
// the value of the pixel at k, with `one` in lane kRayLane, or 0 in all lanes if it is missing.
template <class At>
int64_t Filtered(const Prefilter& filter, const At& at, int64_t one, int lane) {
  const int beside = filter.is_even ? 1 : 0;
  if (at(0, LfPixels::kRayLane) == 0 || at(beside, LfPixels::kRayLane) == 0) return 0;
  const auto sum_of = [&](int of_lane) {
    int64_t sum = filter.is_even ? 0 : filter.weights[0] * at(0, of_lane);
    for (int k = filter.is_even ? 0 : 1; k < filter.count; ++k)
      sum += filter.weights[static_cast<size_t>(k)] * (at(-k, of_lane) + at(beside + k, of_lane));
    return sum;
  };
  const int64_t missing = Prefilter::kOne - sum_of(LfPixels::kRayLane) / one;
  const int64_t middle = filter.is_even ? (at(0, lane) + at(1, lane) + 1) >> 1 : at(0, lane);
  return sum_of(lane) + missing * middle;
}

void FilterAlongRow(const Prefilter& filter, const uint16_t* row, int width, bool /*any_masked*/,
                    int count, int32_t* out) {
  for (int x = 0; x < count; ++x)
    for (int lane = 0; lane < kLanes; ++lane) {
      const auto at = [&](int k, int of_lane) -> int64_t {
        return x + k < 0 || x + k >= width ? 0 : row[(x + k) * kLanes + of_lane];
      };
      out[x * kLanes + lane] = static_cast<int32_t>(
          (Filtered(filter, at, 1, lane) + (1 << (kRowShift - 1))) >> kRowShift);
    }
}

void FilterAlongColumns(const Prefilter& filter, const int32_t* const* rows, bool /*any_missing*/,
                        int row_count, int count, uint16_t* out) {
  for (int y = 0; y < row_count; ++y, ++rows, out += count * kLanes)
    for (ptrdiff_t i = 0; i < count * kLanes; ++i) {
      const ptrdiff_t first = i / kLanes * kLanes;
      const auto at = [&](int k, int of_lane) -> int64_t { return rows[k][first + of_lane]; };
      const int64_t sum =
          Filtered(filter, at, 1 << kPrefilterFraction, static_cast<int>(i - first));
      const int64_t value = (sum + (1 << (kColumnShift - 1))) >> kColumnShift;
      out[i] = static_cast<uint16_t>(value < 0 ? 0 : value > 65535 ? 65535 : value);
    }
}

#else

// The form of a filter as a type, so that compilers unroll the loops.
//   kWeights  Prefilter::count, or 0 for any count
template <bool kEven, int kWeights>
struct FormOf {
  static constexpr bool kIsEven = kEven;
  static constexpr int kCount = kWeights;
  static int CountOf(const Prefilter& filter) { return kWeights > 0 ? kWeights : filter.count; }
};

// Calls body(form) with the form of the filter. Elements of one to four LF pixels have filters of
// three or four different weights.
template <class Body>
HWY_ATTR HWY_INLINE void WithForm(const Prefilter& filter, const Body& body) {
  if (filter.is_even) {
    if (filter.count == 3) return body(FormOf<true, 3>());
    if (filter.count == 4) return body(FormOf<true, 4>());
    if (filter.count == 5) return body(FormOf<true, 5>());
    if (filter.count == 6) return body(FormOf<true, 6>());
    return body(FormOf<true, 0>());
  }
  if (filter.count == 3) return body(FormOf<false, 3>());
  if (filter.count == 4) return body(FormOf<false, 4>());
  if (filter.count == 5) return body(FormOf<false, 5>());
  if (filter.count == 6) return body(FormOf<false, 6>());
  return body(FormOf<false, 0>());
}

// Returns the different weights of the filter, each in all lanes of a vector.
template <class Form, class D>
HWY_ATTR HWY_INLINE auto WeightsOf(D d, const Prefilter& filter) {
  constexpr int kCount = Form::kCount > 0 ? Form::kCount : Prefilter::kMostWeights;
  std::array<hn::Vec<D>, kCount> weights;
  for (size_t k = 0; k < weights.size(); ++k) weights[k] = hn::Set(d, filter.weights[k]);
  return weights;
}

// Returns the values of knots, times Prefilter::kOne; 0 if they are masked. at(k) are the pixels at
// k.
//   weights      WeightsOf() the filter
//   kFraction    lane kRayLane of a pixel that exists is 2^kFraction; the other pixels are 0
//   kAnyMissing  false: all pixels exist
template <class Form, int kFraction, bool kAnyMissing, class D, class Weights, class At>
HWY_ATTR HWY_INLINE hn::Vec<D> Filtered(D d, const Prefilter& filter, const Weights& weights,
                                        const At& at) {
  const auto weight = [&](int k) HWY_ATTR { return weights[static_cast<size_t>(k)]; };
  const auto first = at(0);
  auto middle = first, sum = hn::Mul(first, weight(0));
  if constexpr (Form::kIsEven) {
    const auto pair = hn::Add(first, at(1));
    middle = hn::ShiftRight<1>(hn::Add(pair, hn::Set(d, 1)));
    sum = hn::Mul(pair, weight(0));
  }
  for (int k = 1; k < Form::CountOf(filter); ++k)
    sum = hn::Add(sum, hn::Mul(hn::Add(at(-k), at(k + (Form::kIsEven ? 1 : 0))), weight(k)));
  if constexpr (!kAnyMissing) return sum;
  const auto there = hn::ShiftRight<kFraction>(hn::Broadcast<LfPixels::kRayLane>(sum));
  const auto missing = hn::Sub(hn::Set(d, Prefilter::kOne), there);
  auto exists = hn::Broadcast<LfPixels::kRayLane>(first);
  if constexpr (Form::kIsEven) exists = hn::Min(exists, hn::Broadcast<LfPixels::kRayLane>(at(1)));
  return hn::IfThenElseZero(hn::Gt(exists, hn::Zero(d)), hn::Add(sum, hn::Mul(missing, middle)));
}

// Calls body(d, weights, i) for values [i, i + Lanes(d)) of the pixels [begin, end) of a row, until
// all are done. `weights` are WeightsOf() the filter.
template <class Form, class Body>
HWY_ATTR HWY_INLINE void ForEachVector(const Prefilter& filter, int begin, int end,
                                       const Body& body) {
  const hn::CappedTag<int32_t, 16> d;
  const hn::Full128<int32_t> d_pixel;
  const auto lanes = static_cast<ptrdiff_t>(hn::Lanes(d));
  const ptrdiff_t last = end * kLanes;
  ptrdiff_t i = begin * kLanes;
  const auto weights = WeightsOf<Form>(d, filter);
  for (; i + lanes <= last; i += lanes) body(d, weights, i);
  const auto pixel_weights = WeightsOf<Form>(d_pixel, filter);
  for (; i < last; i += kLanes) body(d_pixel, pixel_weights, i);
}

template <class D>
HWY_ATTR HWY_INLINE hn::Vec<D> LoadValues(D d, const uint16_t* values) {
  return hn::PromoteTo(d, hn::LoadU(hn::Rebind<uint16_t, D>(), values));
}
// Computes knots [begin, end) of a row. All pixels within their reach must be in memory.
template <class Form, bool kAnyMissing>
HWY_ATTR HWY_INLINE void FilterInRow(const Prefilter& filter, const uint16_t* HWY_RESTRICT row,
                                     int begin, int end, int32_t* HWY_RESTRICT out) {
  ForEachVector<Form>(filter, begin, end, [&](auto d, const auto& weights, ptrdiff_t i) HWY_ATTR {
    const auto at = [&](int k) HWY_ATTR { return LoadValues(d, row + i + k * kLanes); };
    const auto sum = Filtered<Form, 0, kAnyMissing>(d, filter, weights, at);
    const auto half = hn::Set(d, 1 << (kRowShift - 1));
    hn::StoreU(hn::ShiftRight<kRowShift>(hn::Add(sum, half)), d, out + i);
  });
}

// Computes knots [begin, end) of a row, some of whose pixels may be masked or missing.
template <class Form>
HWY_ATTR HWY_INLINE void FilterBorder(const Prefilter& filter, const uint16_t* row, int width,
                                      int begin, int end, int32_t* HWY_RESTRICT out) {
  // A copy of the pixels within reach, with masked ones in place of those that do not exist.
  const int reach = filter.count, first = begin - reach, last = end + reach;
  thread_local std::vector<uint16_t> copy;
  copy.assign(static_cast<size_t>(last - first) * kLanes, 0);
  const int from = std::max(first, 0), to = std::min(last, width);
  std::copy(row + from * kLanes, row + to * kLanes, copy.begin() + (from - first) * kLanes);
  FilterInRow<Form, true>(filter, copy.data() + reach * kLanes, 0, end - begin,
                          out + begin * kLanes);
}

// Computes a row of knots.
template <class Form, bool kAnyMissing>
HWY_ATTR HWY_INLINE void FilterInColumns(const Prefilter& filter, const int32_t* const* rows,
                                         int count, uint16_t* HWY_RESTRICT out) {
  ForEachVector<Form>(filter, 0, count, [&](auto d, const auto& weights, ptrdiff_t i) HWY_ATTR {
    const hn::Rebind<uint16_t, decltype(d)> d16;
    const auto at = [&](int k) HWY_ATTR { return hn::LoadU(d, rows[k] + i); };
    const auto sum = Filtered<Form, kPrefilterFraction, kAnyMissing>(d, filter, weights, at);
    const auto half = hn::Set(d, 1 << (kColumnShift - 1));
    hn::StoreU(hn::DemoteTo(d16, hn::ShiftRight<kColumnShift>(hn::Add(sum, half))), d16, out + i);
  });
}

// Computes kKnotRowsAtOnce rows of knots; no pixel may be missing, and the filter must have few
// weights. Each vector of filtered rows is loaded once for all of them.
template <class Form>
HWY_ATTR HWY_INLINE void FilterRowsInColumns(const Prefilter& filter, const int32_t* const* rows,
                                             int count, uint16_t* HWY_RESTRICT out) {
  constexpr int kBefore = Form::kCount - 1;
  constexpr int kRead = kBefore + kKnotRowsAtOnce + kBefore + (Form::kIsEven ? 1 : 0);
  const auto values = static_cast<size_t>(count) * kLanes;
  ForEachVector<Form>(filter, 0, count, [&](auto d, const auto& weights, ptrdiff_t i) HWY_ATTR {
    const hn::Rebind<uint16_t, decltype(d)> d16;
    hn::Vec<decltype(d)> read[kRead];
    for (int k = 0; k < kRead; ++k) read[k] = hn::LoadU(d, rows[k - kBefore] + i);
    for (int y = 0; y < kKnotRowsAtOnce; ++y) {
      const auto at = [&](int k) HWY_ATTR { return read[kBefore + y + k]; };
      const auto sum = Filtered<Form, kPrefilterFraction, false>(d, filter, weights, at);
      const auto half = hn::Set(d, 1 << (kColumnShift - 1));
      hn::StoreU(hn::DemoteTo(d16, hn::ShiftRight<kColumnShift>(hn::Add(sum, half))), d16,
                 out + static_cast<size_t>(y) * values + i);
    }
  });
}

HWY_ATTR void FilterAlongRow(const Prefilter& original, const uint16_t* row, int width,
                             bool any_masked, int count, int32_t* out) {
  const Prefilter filter = original;  // a copy: it cannot change while `out` is written
  WithForm(filter, [&](auto form) HWY_ATTR {
    using Form = decltype(form);
    const int border = filter.count;  // knots at each end that may lack pixels
    if (any_masked || count <= 2 * border)
      return FilterBorder<Form>(filter, row, width, 0, count, out);
    FilterBorder<Form>(filter, row, width, 0, border, out);
    FilterInRow<Form, false>(filter, row, border, count - border, out);
    FilterBorder<Form>(filter, row, width, count - border, count, out);
  });
}

HWY_ATTR void FilterAlongColumns(const Prefilter& original, const int32_t* const* rows,
                                 bool any_missing, int row_count, int count, uint16_t* out) {
  const Prefilter filter = original;
  WithForm(filter, [&](auto form) HWY_ATTR {
    using Form = decltype(form);
    if constexpr (Form::kCount > 0)
      if (row_count == kKnotRowsAtOnce && !any_missing)
        return FilterRowsInColumns<Form>(filter, rows, count, out);
    for (int y = 0; y < row_count; ++y, ++rows, out += static_cast<size_t>(count) * kLanes) {
      if (any_missing)
        FilterInColumns<Form, true>(filter, rows, count, out);
      else
        FilterInColumns<Form, false>(filter, rows, count, out);
    }
  });
}

#endif

}  // namespace HWY_NAMESPACE
}  // namespace lf
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lf {
HWY_EXPORT(FilterAlongRow);
HWY_EXPORT(FilterAlongColumns);

void FilterAlongRow(const Prefilter& filter, const uint16_t* row, int width, bool any_masked,
                    int count, int32_t* out) {
  HWY_DYNAMIC_DISPATCH(FilterAlongRow)(filter, row, width, any_masked, count, out);
}
void FilterAlongColumns(const Prefilter& filter, const int32_t* const* rows, bool any_missing,
                        int row_count, int count, uint16_t* out) {
  HWY_DYNAMIC_DISPATCH(FilterAlongColumns)(filter, rows, any_missing, row_count, count, out);
}

}  // namespace lf
#endif
