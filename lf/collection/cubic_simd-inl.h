// One ray through sixteen pixels by the weights of cubic_weights.h, added to its element.
// Internal to collection. For each instruction set Highway includes it once more.
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

#include "lf/capture/lf_pixels.h"
#include "lf/collection/cubic_weights.h"
#include "lf/plate/tile_sums.h"

HWY_BEFORE_NAMESPACE();
namespace lf {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Products of signed numbers, two and two added, are one operation: values are taken less this.
constexpr uint16_t kMiddle = 0x8000;

// The weights of cubic_weights.h as the kernels take them, by steps.
struct CubicTables {
  HWY_ALIGN int16_t down[kCubicSteps + 1][4];
  // Four times each, for the lanes of a pixel: those of pixels 0, 2, 1, 3.
  HWY_ALIGN int32_t right[kCubicSteps + 1][16];

  CubicTables() {
    for (int step = 0; step <= kCubicSteps; ++step) {
      const CubicTaps taps_down = CubicTapsAt(step, kCubicDownBits);
      const CubicTaps taps_right = CubicTapsAt(step, kCubicRightBits);
      constexpr int kPixels[] = {0, 2, 1, 3};
      for (int i = 0; i < 4; ++i) down[step][i] = static_cast<int16_t>(taps_down[i]);
      for (int i = 0; i < 16; ++i) right[step][i] = taps_right[kPixels[i / 4]];
    }
  }
};

inline const CubicTables& TablesOfCubics() {
  static const CubicTables tables;
  return tables;
}

#if HWY_TARGET == HWY_SCALAR

// The sixteen pixels from `first` on; steps right and down of the inner four.
template <class Weights>
HWY_INLINE void AddCubicRay(const CubicTables& tables, uint32_t right, uint32_t down,
                            const uint16_t* first, ptrdiff_t row_values, const Weights& weights,
                            int i, TileSums::Element* sums) {
  constexpr int kPlaces[] = {0, 8, 4, 12};  // in the table
  for (int lane = 0; lane < LfPixels::kRgbLanes; ++lane) {
    int32_t sum = 1 << (kCubicShift - 1);
    for (int k = 0; k < 4; ++k) {
      int32_t column = 1 << (kCubicColumnShift - 1);
      for (int row = 0; row < 4; ++row)
        column += tables.down[down][row] *
                  (first[row * row_values + k * LfPixels::kRgbLanes + lane] - kMiddle);
      sum += tables.right[right][kPlaces[k]] * (column >> kCubicColumnShift);
    }
    const int32_t value = (sum >> kCubicShift) + kMiddle;
    sums[i].rgb_rays[lane] += static_cast<uint32_t>(std::clamp(value, 0, 0xFFFF)) * weights.At(i);
  }
}

#else

// Of each pixel of the block, or the two of a block: the columns from the first row on, less
// kMiddle; those of the first pixel of each block in `low`, those of the second in `high`.
template <class D16, class V32>
HWY_ATTR HWY_INLINE void MixColumns(D16 d16, const int16_t* down, const uint16_t* first,
                                    ptrdiff_t row_values, V32* low, V32* high) {
  const hn::RebindToSigned<D16> di16;
  const hn::Repartition<int32_t, D16> di;
  const auto middle = hn::Set(d16, kMiddle);
  *low = *high = hn::Set(di, 1 << (kCubicColumnShift - 1));
  for (int row = 0; row < 4; row += 2) {
    const auto upper = hn::Xor(hn::LoadU(d16, first + row * row_values), middle);
    const auto lower = hn::Xor(hn::LoadU(d16, first + (row + 1) * row_values), middle);
    int32_t pair;
    std::memcpy(&pair, down + row, sizeof(pair));
    const auto weights = hn::BitCast(di16, hn::Set(di, pair));
    const auto mix = [&](hn::Vec<D16> both) HWY_ATTR {
      auto odd = hn::Zero(di);
      const auto even =
          hn::ReorderWidenMulAccumulate(di, hn::BitCast(di16, both), weights, hn::Zero(di), odd);
      return hn::RearrangeToOddPlusEven(even, odd);
    };
    *low = hn::Add(*low, mix(hn::InterleaveLower(d16, upper, lower)));
    *high = hn::Add(*high, mix(hn::InterleaveUpper(d16, upper, lower)));
  }
  *low = hn::ShiftRight<kCubicColumnShift>(*low);
  *high = hn::ShiftRight<kCubicColumnShift>(*high);
}

// All sixteen, from the first on, less kMiddle; 2^kCubicShift times.
template <class D>
HWY_ATTR HWY_INLINE hn::Vec<hn::Full128<int32_t>> MixCubic(D d, const int16_t* down,
                                                           const int32_t* right,
                                                           const uint16_t* first,
                                                           ptrdiff_t row_values) {
  const hn::Full128<int32_t> d128;
  const hn::Repartition<uint16_t, D> d16;
  hn::Vec<D> low, high;
  MixColumns(d16, down, first, row_values, &low, &high);
  if constexpr (hn::MaxLanes(d) >= 8) {
    const auto sum =
        hn::Add(hn::Mul(low, hn::LoadU(d, right)), hn::Mul(high, hn::LoadU(d, right + 8)));
    return hn::Add(hn::LowerHalf(d128, sum), hn::UpperHalf(d128, sum));
  } else {
    hn::Vec<D> next_low, next_high;
    MixColumns(d16, down, first + 2 * LfPixels::kRgbLanes, row_values, &next_low, &next_high);
    const auto sum =
        hn::Add(hn::Mul(low, hn::LoadU(d, right)), hn::Mul(high, hn::LoadU(d, right + 8)));
    return hn::Add(sum, hn::Add(hn::Mul(next_low, hn::LoadU(d, right + 4)),
                                hn::Mul(next_high, hn::LoadU(d, right + 12))));
  }
}

// The sixteen pixels from `first` on; steps right and down of the inner four.
template <class Weights>
HWY_ATTR HWY_INLINE void AddCubicRay(const CubicTables& tables, uint32_t right, uint32_t down,
                                     const uint16_t* first, ptrdiff_t row_values,
                                     const Weights& weights, int i, TileSums::Element* sums) {
  const hn::Full128<int32_t> d;
  const hn::Full128<uint32_t> du;
  const auto mixed = MixCubic(hn::CappedTag<int32_t, 8>(), tables.down[down], tables.right[right],
                              first, row_values);
  const auto rounded =
      hn::ShiftRight<kCubicShift>(hn::Add(mixed, hn::Set(d, 1 << (kCubicShift - 1))));
  const auto value = hn::Add(rounded, hn::Set(d, static_cast<int32_t>(kMiddle)));
  const auto clipped = hn::Min(hn::Max(value, hn::Zero(d)), hn::Set(d, 0xFFFF));
  auto ray = hn::BitCast(du, clipped);
  if constexpr (!Weights::kIsOne) ray = hn::Mul(ray, weights.OfPixels(du, i));
  uint32_t* const lanes = sums[i].rgb_rays;
  hn::StoreU(hn::Add(hn::LoadU(du, lanes), ray), du, lanes);
}

#endif

}  // namespace HWY_NAMESPACE
}  // namespace lf
HWY_AFTER_NAMESPACE();

#endif
