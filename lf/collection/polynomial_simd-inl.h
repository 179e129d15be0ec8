// SPDX-License-Identifier: Apache-2.0
// Evaluates the polynomials of a segment, a vector of positions at a time. Internal to collection.
// Highway includes this file once for each instruction set.
#if defined(LF_COLLECTION_POLYNOMIAL_SIMD_INL_H_) == \
    defined(HWY_TARGET_TOGGLE)  // NOLINT: Highway's guard
#ifdef LF_COLLECTION_POLYNOMIAL_SIMD_INL_H_
#undef LF_COLLECTION_POLYNOMIAL_SIMD_INL_H_
#else
#define LF_COLLECTION_POLYNOMIAL_SIMD_INL_H_
#endif

#include <hwy/highway.h>

#include "lf/collection/segments.h"

HWY_BEFORE_NAMESPACE();
namespace lf {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using LaneF = hn::CappedTag<float, 16>;
using LaneI = hn::RebindToSigned<LaneF>;
#if HWY_HAVE_SCALABLE
#error "vectors of unknown length need loops over Lanes()"
#endif
constexpr int kLanes = static_cast<int>(hn::MaxLanes(LaneF()));

// Evaluates a polynomial without fused multiply-add, so that results are bit-identical on every
// instruction set.
//   kDegree  5; or 3 if c[4] and c[5] are 0, which is faster and has the same result
template <int kDegree>
class PolynomialLanes {
 public:
  explicit HWY_ATTR HWY_INLINE PolynomialLanes(const float (&c)[Segment::kTerms])
      : c0_(hn::Set(LaneF(), c[0])),
        c1_(hn::Set(LaneF(), c[1])),
        c2_(hn::Set(LaneF(), c[2])),
        c3_(hn::Set(LaneF(), c[3])),
        c4_(hn::Set(LaneF(), c[4])),
        c5_(hn::Set(LaneF(), c[5])) {
    static_assert(kDegree == 3 || kDegree == 5);
  }

  HWY_ATTR HWY_INLINE hn::Vec<LaneF> At(hn::Vec<LaneF> t) const {
    auto value = c3_;
    if constexpr (kDegree == 5) value = hn::Add(hn::Mul(hn::Add(hn::Mul(c5_, t), c4_), t), value);
    return hn::Add(hn::Mul(hn::Add(hn::Mul(hn::Add(hn::Mul(value, t), c2_), t), c1_), t), c0_);
  }

 private:
  hn::Vec<LaneF> c0_, c1_, c2_, c3_, c4_, c5_;
};

}  // namespace HWY_NAMESPACE
}  // namespace lf
HWY_AFTER_NAMESPACE();

#endif
