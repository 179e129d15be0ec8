// SPDX-License-Identifier: Apache-2.0
// Adds the mean of several rays of an element as the element's one ray. Internal to collection.
// Highway includes this file once for each instruction set.
#if defined(LF_COLLECTION_ELEMENT_MEANS_SIMD_INL_H_) == \
    defined(HWY_TARGET_TOGGLE)  // NOLINT: Highway's guard
#ifdef LF_COLLECTION_ELEMENT_MEANS_SIMD_INL_H_
#undef LF_COLLECTION_ELEMENT_MEANS_SIMD_INL_H_
#else
#define LF_COLLECTION_ELEMENT_MEANS_SIMD_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cstdint>

#include "lf/collection/ray_weight_simd-inl.h"
#include "lf/film/plate/tile_sums.h"
#include "lf/light_field/model/lf_pixels.h"

HWY_BEFORE_NAMESPACE();
namespace lf {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Adds to each of `count` elements of a row the mean of the element's rays, rounded half up. An
// element has up to samples^2 rays, whose sums are in `samples` successive elements of `fine`.
// Returns the number of elements that have a ray.
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

// Float division followed by ConvertTo(), which drops the fraction, is exact for numbers up to
// 2^24, because a quotient that is no integer is farther from the nearest integer than the
// precision of a float.

template <class Weights>
HWY_ATTR uint64_t AddMeans(const TileSums::Element* fine, int samples, int count,
                           const Weights& weights, TileSums::Element* sums) {
  const hn::Full128<uint32_t> du;
  const hn::Full128<int32_t> di;
  const hn::Full128<float> df;
  auto rays = hn::Zero(di);  // lane kRayLane: the number of rays
  for (int i = 0; i < count; ++i, fine += samples) {
    auto sum = hn::Load(du, fine[0].rgb_rays);
    for (int k = 1; k < samples; ++k) sum = hn::Add(sum, hn::Load(du, fine[k].rgb_rays));
    const auto rays_and_sums = hn::BitCast(di, sum);
    const auto added = hn::Broadcast<LfPixels::kRayLane>(rays_and_sums);
    const auto dividend = hn::Add(rays_and_sums, hn::ShiftRight<1>(added));
    // If the element has no ray, all lanes are 0: 0 is then divided by 1.
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

}  // namespace HWY_NAMESPACE
}  // namespace lf
HWY_AFTER_NAMESPACE();

#endif
