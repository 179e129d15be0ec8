// SPDX-License-Identifier: Apache-2.0
// Adds several rays at once to their elements. Each ray is interpolated between four pixels.
// Internal to collection. Highway includes this file once for each instruction set.
#if defined(LF_COLLECTION_BILINEAR_SIMD_INL_H_) == \
    defined(HWY_TARGET_TOGGLE)  // NOLINT: Highway's guard
#ifdef LF_COLLECTION_BILINEAR_SIMD_INL_H_
#undef LF_COLLECTION_BILINEAR_SIMD_INL_H_
#else
#define LF_COLLECTION_BILINEAR_SIMD_INL_H_
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

#include "lf/collection/gather_places_simd-inl.h"
#include "lf/film/plate/tile_sums.h"
#include "lf/light_field/model/lf_pixels.h"

HWY_BEFORE_NAMESPACE();
namespace lf {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Half of the sum of the weights of a ray's four pixels. It is added to the weighted sum of the
// pixels, which is thereby rounded half up. The largest result, 65535 * 65536 + kHalf, just fits
// into 32 bits.
constexpr uint32_t kHalf = kOne * kOne / 2;

// AddRays() adds rays [i, i + kRaysAtOnce) of `places` to the elements with the same indices in
// `sums`, multiplied by `weights` at the same indices. AddRay() does so for ray i alone.
//   values      the first pixel of the LF image's loaded rectangle
//   row_values  number of values from one row of pixels to the next
#if HWY_TARGET == HWY_SCALAR

constexpr int kRaysAtOnce = 1;

// Returns lane `lane` of ray i, rounded.
HWY_INLINE uint32_t MixedLane(const Places& places, int i, const uint16_t* values,
                              ptrdiff_t row_values, int lane) {
  const uint16_t* upper = values + static_cast<ptrdiff_t>(places.pixel[i]) * LfPixels::kRgbLanes;
  const uint16_t* lower = upper + row_values;
  const uint32_t right = places.left_right[i] >> 16, left = kOne - right, down = places.lower[i];
  const int next = lane + LfPixels::kRgbLanes;
  const uint32_t sum = (upper[lane] * left + upper[next] * right) * (kOne - down) +
                       (lower[lane] * left + lower[next] * right) * down;
  return (sum + kHalf) >> (2 * kWeightBits);
}

template <class Weights>
HWY_INLINE void AddRays(const Places& places, int i, const uint16_t* values, ptrdiff_t row_values,
                        const Weights& weights, TileSums::Element* sums) {
  for (int lane = 0; lane < LfPixels::kRgbLanes; ++lane)
    sums[i].rgb_rays[lane] += MixedLane(places, i, values, row_values, lane) * weights.At(i);
}
template <class Weights>
constexpr auto AddRay = AddRays<Weights>;

#else

using AllLanes = hn::CappedTag<uint32_t, 16>;
using LanesOfOne = hn::Full128<uint32_t>;
constexpr int kRaysAtOnce = static_cast<int>(hn::MaxLanes(AllLanes())) / LfPixels::kRgbLanes;

// Loads two adjacent pixels for each ray into a block of 128 bits. Block k gets the pixel with the
// index pixel[k] in `values` and the pixel to the right of it.
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

// Returns weights[k] in all lanes of block k.
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

// Returns first * (256 - weight) + second * weight, modulo 2^32.
template <class V>
HWY_ATTR HWY_INLINE V Mix(V first, V second, V weight) {
  return hn::Add(hn::ShiftLeft<kWeightBits>(first), hn::Mul(hn::Sub(second, first), weight));
}

// Interleaves the lanes of the two pixels in each block, so that both values of a colour are
// adjacent.
template <class D16>
HWY_ATTR HWY_INLINE hn::Vec<D16> SideBySide(D16 d16, hn::Vec<D16> pairs) {
  HWY_ALIGN static constexpr uint8_t kBytes[16] = {0, 1, 8,  9,  2, 3, 10, 11,
                                                   4, 5, 12, 13, 6, 7, 14, 15};
  const hn::Repartition<uint8_t, D16> d8;
  return hn::BitCast(d16, hn::TableLookupBytes(hn::BitCast(d8, pairs), hn::LoadDup128(d8, kBytes)));
}

// Returns rays from `i` on, interpolated and rounded: one in each block of 128 bits of the vector.
template <class D>
HWY_ATTR HWY_INLINE hn::Vec<D> MixedRays(D d, const Places& places, int i, const uint16_t* values,
                                         ptrdiff_t row_values) {
  const hn::Repartition<uint16_t, D> d16;
  const hn::RebindToSigned<D> di;
  const hn::RebindToSigned<decltype(d16)> di16;
  const auto middle = hn::Set(d16, kMiddle);
  const auto left_right = hn::BitCast(di16, LoadWeights(d, places.left_right + i));
  const auto mix_row = [&](const uint16_t* row) HWY_ATTR {
    const auto pairs = SideBySide(d16, LoadPairs(d16, row, places.pixel + i));
    const auto about_0 = hn::BitCast(di16, hn::Xor(pairs, middle));
    auto odd = hn::Zero(di);
    const auto even = hn::ReorderWidenMulAccumulate(di, about_0, left_right, hn::Zero(di), odd);
    return hn::BitCast(d, hn::RearrangeToOddPlusEven(even, odd));
  };
  const auto sum =
      Mix(mix_row(values), mix_row(values + row_values), LoadWeights(d, places.lower + i));
  // Adds back kMiddle, which was subtracted from each pixel, times the sum of all weights (65536).
  // Adds kHalf to round half up.
  constexpr uint32_t kBack = uint32_t{kMiddle} * kOne * kOne + kHalf;
  return hn::ShiftRight<2 * kWeightBits>(hn::Add(sum, hn::Set(d, kBack)));
}

// Adds rays from `i` on: one for each block of 128 bits in a vector of `D`.
template <class D, class Weights>
HWY_ATTR HWY_INLINE void AddRaysOf(D d, const Places& places, int i, const uint16_t* values,
                                   ptrdiff_t row_values, const Weights& weights,
                                   TileSums::Element* sums) {
  auto rays = MixedRays(d, places, i, values, row_values);
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

}  // namespace HWY_NAMESPACE
}  // namespace lf
HWY_AFTER_NAMESPACE();

#endif
