// SPDX-License-Identifier: Apache-2.0
// Adds one ray, interpolated between sixteen pixels with the weights of cubic_weights.h, to its
// element. Internal to collection. Highway includes this file once for each instruction set.
#if defined(LF_COLLECTION_CUBIC_SIMD_INL_H_) == \
    defined(HWY_TARGET_TOGGLE)  // NOLINT: Highway's guard
#ifdef LF_COLLECTION_CUBIC_SIMD_INL_H_
#undef LF_COLLECTION_CUBIC_SIMD_INL_H_
#else
#define LF_COLLECTION_CUBIC_SIMD_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "lf/collection/cubic_weights.h"
#include "lf/collection/gather_places_simd-inl.h"
#include "lf/film/plate/tile_sums.h"
#include "lf/light_field/model/lf_pixels.h"

HWY_BEFORE_NAMESPACE();
namespace lf {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// The weights of cubic_weights.h for each step, in the layout that the kernels read.
struct CubicTables {
  HWY_ALIGN int16_t down[kCubicSteps + 1][4];
  // In right[step], each weight is repeated four times, once for each lane of a pixel. The weights
  // of column k begin at kPlaces[k].
  static constexpr int kPlaces[] = {0, 8, 4, 12};
  HWY_ALIGN int32_t right[kCubicSteps + 1][16];

  CubicTables() {
    for (int step = 0; step <= kCubicSteps; ++step) {
      const CubicTaps taps_down = CubicTapsAt(step, kCubicDownBits);
      const CubicTaps taps_right = CubicTapsAt(step, kCubicRightBits);
      for (int k = 0; k < 4; ++k) {
        down[step][k] = static_cast<int16_t>(taps_down[k]);
        std::fill_n(right[step] + kPlaces[k], 4, taps_right[k]);
      }
    }
  }
};

inline const CubicTables& TablesOfCubics() {
  static const CubicTables tables;
  return tables;
}

#if HWY_TARGET == HWY_SCALAR

// Returns lane `lane` of the ray between the sixteen pixels that begin at `first`. `right` and
// `down` are the distances of the ray from the upper left one of the inner four pixels, in steps of
// 1 / kCubicSteps px.
HWY_INLINE uint32_t CubicLane(const CubicTables& tables, uint32_t right, uint32_t down,
                              const uint16_t* first, ptrdiff_t row_values, int lane) {
  int32_t sum = 1 << (kCubicShift - 1);
  for (int k = 0; k < 4; ++k) {
    int32_t column = 1 << (kCubicColumnShift - 1);
    for (int row = 0; row < 4; ++row)
      column += tables.down[down][row] *
                (first[row * row_values + k * LfPixels::kRgbLanes + lane] - kMiddle);
    sum += tables.right[right][CubicTables::kPlaces[k]] * (column >> kCubicColumnShift);
  }
  return static_cast<uint32_t>(std::clamp((sum >> kCubicShift) + kMiddle, 0, 0xFFFF));
}

// Adds the ray of CubicLane() to element i of `sums`.
template <class Weights>
HWY_INLINE void AddCubicRay(const CubicTables& tables, uint32_t right, uint32_t down,
                            const uint16_t* first, ptrdiff_t row_values, const Weights& weights,
                            int i, TileSums::Element* sums) {
  for (int lane = 0; lane < LfPixels::kRgbLanes; ++lane)
    sums[i].rgb_rays[lane] +=
        CubicLane(tables, right, down, first, row_values, lane) * weights.At(i);
}

#else

using SixteenTag = hn::CappedTag<int32_t, 8>;

// Mixes columns of four pixels, the topmost of which are at `first`: sums (pixel - kMiddle) *
// weight and divides the sum by 2^kCubicColumnShift, rounded half up. Writes the mixed columns of
// the first pixel in each block of 128 bits to `low`, those of the second pixel to `high`.
//   upper, lower  weights of rows 0 and 1, and of rows 2 and 3, interleaved
template <class D16, class V16, class V32>
HWY_ATTR HWY_INLINE void MixColumns(D16 d16, V16 upper, V16 lower, const uint16_t* first,
                                    ptrdiff_t row_values, V32* low, V32* high) {
  const hn::RebindToSigned<D16> di16;
  const hn::Repartition<int32_t, D16> di;
  const auto middle = hn::Set(d16, kMiddle);
  *low = *high = hn::Set(di, 1 << (kCubicColumnShift - 1));
  const auto add_rows = [&](int row, V16 weight) HWY_ATTR {
    const auto above = hn::Xor(hn::LoadU(d16, first + row * row_values), middle);
    const auto below = hn::Xor(hn::LoadU(d16, first + (row + 1) * row_values), middle);
    const auto mix = [&](hn::Vec<D16> both) HWY_ATTR {
      auto odd = hn::Zero(di);
      const auto even =
          hn::ReorderWidenMulAccumulate(di, hn::BitCast(di16, both), weight, hn::Zero(di), odd);
      return hn::RearrangeToOddPlusEven(even, odd);
    };
    *low = hn::Add(*low, mix(hn::InterleaveLower(d16, above, below)));
    *high = hn::Add(*high, mix(hn::InterleaveUpper(d16, above, below)));
  };
  add_rows(0, upper);
  add_rows(2, lower);
  *low = hn::ShiftRight<kCubicColumnShift>(*low);
  *high = hn::ShiftRight<kCubicColumnShift>(*high);
}

// Returns the weighted sum of the four mixed columns of the sixteen pixels that begin at `first`.
//   upper, lower  weights of rows, as for MixColumns()
//   right         weights of the columns, in the layout of CubicTables::right
template <class D, class V16>
HWY_ATTR HWY_INLINE hn::Vec<hn::Full128<int32_t>> MixSixteen(D d, V16 upper, V16 lower,
                                                             const int32_t* right,
                                                             const uint16_t* first,
                                                             ptrdiff_t row_values) {
  const hn::Full128<int32_t> d128;
  const hn::Repartition<uint16_t, D> d16;
  hn::Vec<D> low, high;
  MixColumns(d16, upper, lower, first, row_values, &low, &high);
  if constexpr (hn::MaxLanes(d) >= 8) {
    const auto sum =
        hn::Add(hn::Mul(low, hn::LoadU(d, right)), hn::Mul(high, hn::LoadU(d, right + 8)));
    return hn::Add(hn::LowerHalf(d128, sum), hn::UpperHalf(d128, sum));
  } else {
    hn::Vec<D> next_low, next_high;
    MixColumns(d16, upper, lower, first + ptrdiff_t{2} * LfPixels::kRgbLanes, row_values, &next_low,
               &next_high);
    const auto sum =
        hn::Add(hn::Mul(low, hn::LoadU(d, right)), hn::Mul(high, hn::LoadU(d, right + 8)));
    return hn::Add(sum, hn::Add(hn::Mul(next_low, hn::LoadU(d, right + 4)),
                                hn::Mul(next_high, hn::LoadU(d, right + 12))));
  }
}

// Returns the ray between the sixteen pixels that begin at `first`. `right` and `down` are the
// distances of the ray from the upper left one of the inner four pixels, in steps of
// 1 / kCubicSteps px.
HWY_ATTR HWY_INLINE hn::Vec<hn::Full128<int32_t>> CubicRay(const CubicTables& tables,
                                                           uint32_t right, uint32_t down,
                                                           const uint16_t* first,
                                                           ptrdiff_t row_values) {
  const hn::Full128<int32_t> d;
  const SixteenTag d_all;
  const hn::Repartition<int16_t, SixteenTag> d16;
  const auto rows = [&](int row) HWY_ATTR {
    int32_t pair;
    std::memcpy(&pair, tables.down[down] + row, sizeof(pair));
    return hn::BitCast(d16, hn::Set(d_all, pair));
  };
  const auto mixed = MixSixteen(d_all, rows(0), rows(2), tables.right[right], first, row_values);
  const auto rounded =
      hn::ShiftRight<kCubicShift>(hn::Add(mixed, hn::Set(d, 1 << (kCubicShift - 1))));
  const auto value = hn::Add(rounded, hn::Set(d, static_cast<int32_t>(kMiddle)));
  return hn::Min(hn::Max(value, hn::Zero(d)), hn::Set(d, 0xFFFF));
}

// Adds the ray of CubicRay() to element i of `sums`.
template <class Weights>
HWY_ATTR HWY_INLINE void AddCubicRay(const CubicTables& tables, uint32_t right, uint32_t down,
                                     const uint16_t* first, ptrdiff_t row_values,
                                     const Weights& weights, int i, TileSums::Element* sums) {
  const hn::Full128<uint32_t> du;
  auto ray = hn::BitCast(du, CubicRay(tables, right, down, first, row_values));
  if constexpr (!Weights::kIsOne) ray = hn::Mul(ray, weights.OfPixels(du, i));
  uint32_t* const lanes = sums[i].rgb_rays;
  hn::StoreU(hn::Add(hn::LoadU(du, lanes), ray), du, lanes);
}

#endif

}  // namespace HWY_NAMESPACE
}  // namespace lf
HWY_AFTER_NAMESPACE();

#endif
