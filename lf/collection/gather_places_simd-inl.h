// SPDX-License-Identifier: Apache-2.0
// Finds the positions in an LF image where the rays of consecutive elements were recorded. Internal
// to collection. Highway includes this file once for each instruction set.
#if defined(LF_COLLECTION_GATHER_PLACES_SIMD_INL_H_) == \
    defined(HWY_TARGET_TOGGLE)  // NOLINT: Highway's guard
#ifdef LF_COLLECTION_GATHER_PLACES_SIMD_INL_H_
#undef LF_COLLECTION_GATHER_PLACES_SIMD_INL_H_
#else
#define LF_COLLECTION_GATHER_PLACES_SIMD_INL_H_
#endif

#include <hwy/highway.h>

#include <bit>
#include <cstdint>

#include "lf/collection/gather_sampling.h"
#include "lf/collection/polynomial_simd-inl.h"
#include "lf/collection/segments.h"
#include "lf/core/geometry.h"

HWY_BEFORE_NAMESPACE();
namespace lf {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr int kWeightBits = 8;
constexpr int kOne = 1 << kWeightBits;  // sum of the weights along x, or along y

// kMiddle is subtracted from the values of pixels, because the instruction that multiplies pairs of
// numbers and adds the two products needs signed numbers.
constexpr uint16_t kMiddle = 0x8000;

// For each of consecutive elements: the upper left one of the four pixels around its ray, as an
// index into the loaded rectangle, and the weights of the pixels.
struct Places {
  static constexpr int kRoom = Segment::kMaxCount + kLanes;
  HWY_ALIGN int32_t pixel[kRoom];
  HWY_ALIGN uint32_t left_right[kRoom];  // weights of the left (low 16 bits) and the right pixels
  HWY_ALIGN uint32_t lower[kRoom];       // weights of the two lower pixels
  // Phase of the Bayer pattern: x % 2 + 2 (y % 2), where (x, y) is the upper left one of the four
  // pixels, counted in the whole LF image. Only set if NeedsPhases() is true.
  HWY_ALIGN int32_t phase[kRoom];
};

// An integer between -2^22 and 2^22 is exact in single precision. If it is added to 2^23 + 2^22,
// the last bits of the sum are the integer: this is cheaper than a conversion, which checks for
// overflow.
constexpr float kWhole = 12582912;

// One coordinate of a position: the last pixel whose knot is not to the right of the position (or
// below it), counted from the first pixel of the loaded rectangle, and the distance of the position
// from this knot in 1/256 px. (The knot is the pixel's centre unless Prefilter::is_even is true.)
struct Coordinate {
  hn::Vec<LaneI> pixel;
  hn::Vec<LaneI> weight;
};

// Computes one coordinate of positions. Pixels [begin, end) are loaded.
template <int kDegree>
class CoordinateFinder {
 public:
  //   first_px  position of a pixel's knot, from the pixel's left (or upper) border: 0.5 if knots
  //             are at pixel centres
  HWY_ATTR HWY_INLINE CoordinateFinder(const float (&polynomial)[Segment::kTerms], int32_t base,
                                       int begin, int end, float first_px)
      : base_((base - begin) * kOne - std::bit_cast<int32_t>(kWhole)), last_(end - begin - 1) {
    // The value of polynomial_ is in 1/256 px, from the knot of pixel `base`, plus 1/2 so that
    // Floor() rounds half up. Multiplying by 256 is exact.
    for (int power = 0; power < Segment::kTerms; ++power)
      polynomial_[power] = polynomial[power] * kOne;
    polynomial_[0] += 0.5F - first_px * kOne;
  }

  HWY_ATTR HWY_INLINE Coordinate Find(hn::Vec<LaneF> t) const {
    const LaneI di;
    const auto place = PolynomialLanes<kDegree>(polynomial_).At(t);
    const auto whole = hn::BitCast(di, hn::Add(hn::Floor(place), hn::Set(LaneF(), kWhole)));
    const auto found = hn::Add(whole, hn::Set(di, base_));
    // A position beyond the outermost knots is moved back to them. Rounding may put it there, or
    // knots that stand between pixels and therefore begin 1 px from the border.
    const auto position = hn::Min(hn::Max(found, hn::Zero(di)), hn::Set(di, last_ * kOne));
    const auto pixel = hn::Min(hn::ShiftRight<kWeightBits>(position), hn::Set(di, last_ - 1));
    return {pixel, hn::Sub(position, hn::ShiftLeft<kWeightBits>(pixel))};
  }

 private:
  float polynomial_[Segment::kTerms];
  int32_t base_;  // (base - begin) in 1/256 px, minus the bits of the float kWhole
  int32_t last_;
};

// True if Places::phase is needed.
inline bool NeedsPhases(const GatherSampling& sampling) {
  return sampling.filter == PixelFilter::kMosaic && !sampling.prefilter.by_shares;
}

// FindPlaces(), for a polynomial of degree kDegree.
//   kIsPlain  true if the filter is neither kNearest nor one that needs phases
template <int kDegree, bool kIsPlain>
HWY_ATTR void FindPlacesBy(const Segment& s, int begin, int count, const PixelRect& rect,
                           const GatherSampling& sampling, Places* places) {
  const LaneF df;
  const LaneI di;
  const hn::RebindToUnsigned<LaneI> du;
  const float first_px = sampling.prefilter.is_even ? 1.0F : 0.5F;
  const CoordinateFinder<kDegree> x_finder(s.x_poly, s.base_x, rect.x_begin, rect.x_end, first_px);
  const CoordinateFinder<kDegree> y_finder(s.y_poly, s.base_y, rect.y_begin, rect.y_end, first_px);
  const auto width = hn::Set(di, rect.width());
  // kNearest rounds a weight to kOne or 0: it adds half of kOne and keeps only the bit of kOne.
  const bool is_nearest = sampling.filter == PixelFilter::kNearest;
  const auto half = hn::Set(di, is_nearest ? kOne / 2 : 0);
  const auto kept_bits = hn::Set(di, is_nearest ? kOne : -1);
  const auto weight_of = [&](hn::Vec<LaneI> weight) HWY_ATTR {
    return kIsPlain ? weight : hn::And(hn::Add(weight, half), kept_bits);
  };
  const auto store = [&](const Coordinate& x, const Coordinate& y, int i) HWY_ATTR {
    hn::Store(hn::Add(hn::Mul(y.pixel, width), x.pixel), di, places->pixel + i);
    const auto right_weight = weight_of(x.weight);
    const auto left_weight = hn::Sub(hn::Set(di, kOne), right_weight);
    hn::Store(hn::BitCast(du, hn::Or(left_weight, hn::ShiftLeft<16>(right_weight))), du,
              places->left_right + i);
    hn::Store(hn::BitCast(du, weight_of(y.weight)), du, places->lower + i);
    if (!kIsPlain && NeedsPhases(sampling)) {
      const auto odd = [](hn::Vec<LaneI> pixel, int first) HWY_ATTR {
        return hn::And(hn::Xor(pixel, hn::Set(LaneI(), first)), hn::Set(LaneI(), 1));
      };
      hn::Store(hn::Or(odd(x.pixel, rect.x_begin), hn::ShiftLeft<1>(odd(y.pixel, rect.y_begin))),
                di, places->phase + i);
    }
  };
  auto t = hn::Iota(df, s.t_begin + static_cast<float>(begin));
  const auto step = hn::Set(df, kLanes);
  for (int i = 0; i < count; i += kLanes, t = hn::Add(t, step))
    store(x_finder.Find(t), y_finder.Find(t), i);
}

// Finds the places of elements [begin, begin + count) of the segment.
//   rect  the pixels that are loaded
inline void FindPlaces(const Segment& s, int begin, int count, const PixelRect& rect,
                       const GatherSampling& sampling, Places* places) {
  const bool is_plain = sampling.filter != PixelFilter::kNearest && !NeedsPhases(sampling);
  const auto find = s.is_cubic() ? (is_plain ? FindPlacesBy<3, true> : FindPlacesBy<3, false>)
                                 : (is_plain ? FindPlacesBy<5, true> : FindPlacesBy<5, false>);
  find(s, begin, count, rect, sampling, places);
}

}  // namespace HWY_NAMESPACE
}  // namespace lf
HWY_AFTER_NAMESPACE();

#endif
