// SPDX-License-Identifier: Apache-2.0
// The weights of rays in the three kinds that kernels read: all 1, all equal, or one for each
// element. Internal to collection. Highway includes this file once for each instruction set.
#if defined(LF_COLLECTION_RAY_WEIGHT_SIMD_INL_H_) == \
    defined(HWY_TARGET_TOGGLE)  // NOLINT: Highway's guard
#ifdef LF_COLLECTION_RAY_WEIGHT_SIMD_INL_H_
#undef LF_COLLECTION_RAY_WEIGHT_SIMD_INL_H_
#else
#define LF_COLLECTION_RAY_WEIGHT_SIMD_INL_H_
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>
#include <cstring>

HWY_BEFORE_NAMESPACE();
namespace lf {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Each kind of weights has these functions:
//   At(i)           returns the weight of element i
//   OfWords(d, i)   returns, in lane k, the weight of element i + k
//   OfPixels(d, i)  returns, in all four lanes of pixel k, the weight of element i + k
//   From(i)         returns the weights of elements i, i + 1, ...
// WeightOne has no OfWords() and OfPixels(), because kernels do not multiply if kIsOne is true.
struct WeightOne {
  static constexpr bool kIsOne = true;
  static constexpr bool kIsSame = true;
  uint32_t At(ptrdiff_t /*i*/) const { return 1; }
  WeightOne From(ptrdiff_t /*i*/) const { return *this; }
};

struct WeightSame {
  static constexpr bool kIsOne = false;
  static constexpr bool kIsSame = true;
  uint32_t weight;
  uint32_t At(ptrdiff_t /*i*/) const { return weight; }
  WeightSame From(ptrdiff_t /*i*/) const { return *this; }
#if HWY_TARGET != HWY_SCALAR
  template <class D>
  HWY_ATTR HWY_INLINE hn::Vec<D> OfWords(D d32, ptrdiff_t /*i*/) const {
    return hn::Set(d32, weight);
  }
  template <class D>
  HWY_ATTR HWY_INLINE hn::Vec<D> OfPixels(D d32, ptrdiff_t /*i*/) const {
    return hn::Set(d32, weight);
  }
#endif
};

struct WeightByElement {
  static constexpr bool kIsOne = false;
  static constexpr bool kIsSame = false;
  const uint8_t* weights;
  uint32_t At(ptrdiff_t i) const { return weights[i]; }
  WeightByElement From(ptrdiff_t i) const { return {weights + i}; }
#if HWY_TARGET != HWY_SCALAR
  template <class D>
  HWY_ATTR HWY_INLINE hn::Vec<D> OfWords(D d32, ptrdiff_t i) const {
    const hn::Rebind<uint8_t, D> d8;
    return hn::PromoteTo(d32, hn::LoadU(d8, weights + i));
  }
  template <class D>
  HWY_ATTR HWY_INLINE hn::Vec<D> OfPixels(D d32, ptrdiff_t i) const {
    constexpr size_t kPixels = hn::MaxLanes(d32) / 4;
    uint32_t bytes = 0;
    std::memcpy(&bytes, weights + i, kPixels);
    // The shift grows by eight bits from one pixel to the next.
    const auto shift = hn::ShiftLeft<3>(hn::ShiftRight<2>(hn::Iota(d32, 0)));
    return hn::And(hn::Shr(hn::Set(d32, bytes), shift), hn::Set(d32, 0xFF));
  }
#endif
};

}  // namespace HWY_NAMESPACE
}  // namespace lf
HWY_AFTER_NAMESPACE();

#endif
