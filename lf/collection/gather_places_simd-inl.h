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

#include <algorithm>
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
  static constexpr int kRoom = Segment::kMaxCount + std::max(kLanes, Segment::kParabola);
  HWY_ALIGN int32_t pixel[kRoom];
  HWY_ALIGN uint32_t left_right[kRoom];  // weights of the left (low 16 bits) and the right pixels
  HWY_ALIGN uint32_t lower[kRoom];       // weights of the two lower pixels
};

// An integer between -2^22 and 2^22 is exact in single precision. If it is added to 2^23 + 2^22,
// the last bits of the sum are the integer: this is cheaper than a conversion, which checks for
// overflow.
constexpr float kWhole = 12582912;

// Returns the last integer that is not above `value`, plus the bits of the float kWhole.
HWY_ATTR HWY_INLINE hn::Vec<LaneI> FloorAndBits(hn::Vec<LaneF> value) {
  return hn::BitCast(LaneI(), hn::Add(hn::Floor(value), hn::Set(LaneF(), kWhole)));
}

// One coordinate of the positions of a segment: a polynomial of t with the coefficients c, plus
// `base`, in 1/256 px from the first knot of the loaded rectangle, plus 1/2 so that Floor() rounds
// half up. (A knot is a pixel's centre unless Prefilter::is_even is true.)
struct KnotPolynomial {
  float c[Segment::kTerms];
  int32_t base;
  int32_t last;  // the last loaded pixel, counted from the first one

  // Pixels [begin, end) are loaded.
  //   first_px  position of a pixel's knot, from the pixel's left (or upper) border: 0.5 if knots
  //             are at pixel centres
  HWY_INLINE KnotPolynomial(const float (&polynomial)[Segment::kTerms], int32_t segment_base,
                            int begin, int end, float first_px)
      : base((segment_base - begin) * kOne), last(end - begin - 1) {
    // Multiplying by 256 is exact.
    for (int power = 0; power < Segment::kTerms; ++power) c[power] = polynomial[power] * kOne;
    c[0] += 0.5F - first_px * kOne;
  }

  // Returns `base` less the bits that FloorAndBits() adds.
  int32_t BaseLessBits() const { return base - std::bit_cast<int32_t>(kWhole); }
};

// One coordinate of a position: the last pixel whose knot is not to the right of the position (or
// below it), counted from the first pixel of the loaded rectangle, and the distance of the position
// from this knot in 1/256 px.
struct Coordinate {
  hn::Vec<LaneI> pixel;
  hn::Vec<LaneI> weight;
};

// Splits a position in 1/256 px from the first knot of the loaded rectangle.
//   kClamps  true: A position beyond the outermost knots is moved back to them. Rounding may put it
//            there, or knots that stand between pixels and therefore begin 1 px from the border
template <bool kClamps>
HWY_ATTR HWY_INLINE Coordinate Split(hn::Vec<LaneI> found, int32_t last) {
  const LaneI di;
  if constexpr (!kClamps)
    return {hn::ShiftRight<kWeightBits>(found), hn::And(found, hn::Set(di, kOne - 1))};
  const auto position = hn::Min(hn::Max(found, hn::Zero(di)), hn::Set(di, last * kOne));
  const auto pixel = hn::Min(hn::ShiftRight<kWeightBits>(position), hn::Set(di, last - 1));
  return {pixel, hn::Sub(position, hn::ShiftLeft<kWeightBits>(pixel))};
}

// Stores places.
//   kIsPlain  true if the filter is not kNearest
template <bool kIsPlain>
class PlaceWriter {
 public:
  HWY_INLINE PlaceWriter(const PixelRect& rect, const GatherSampling& sampling, Places* places)
      : rect_(rect), is_nearest_(sampling.filter == PixelFilter::kNearest), places_(places) {}

  // Stores the places of kLanes elements, the first of which is element i.
  HWY_ATTR HWY_INLINE void Store(const Coordinate& x, const Coordinate& y, int i) const {
    const LaneI di;
    const hn::RebindToUnsigned<LaneI> du;
    const auto width = hn::Set(di, rect_.width());
    hn::StoreU(hn::Add(hn::Mul(y.pixel, width), x.pixel), di, places_->pixel + i);
    const auto right_weight = Rounded(x.weight);
    const auto left_weight = hn::Sub(hn::Set(di, kOne), right_weight);
    hn::StoreU(hn::BitCast(du, hn::Or(left_weight, hn::ShiftLeft<16>(right_weight))), du,
               places_->left_right + i);
    hn::StoreU(hn::BitCast(du, Rounded(y.weight)), du, places_->lower + i);
  }

 private:
  // kNearest rounds a weight to kOne or 0: it adds half of kOne and keeps only the bit of kOne.
  HWY_ATTR HWY_INLINE hn::Vec<LaneI> Rounded(hn::Vec<LaneI> weight) const {
    if (kIsPlain || !is_nearest_) return weight;
    return hn::And(hn::Add(weight, hn::Set(LaneI(), kOne / 2)), hn::Set(LaneI(), kOne));
  }

  const PixelRect& rect_;
  bool is_nearest_;
  Places* places_;
};

// Stores the places of `count` elements, from t on, by a polynomial of degree kDegree.
template <int kDegree, bool kIsPlain>
HWY_ATTR void StoreByPolynomials(const KnotPolynomial& x, const KnotPolynomial& y, float first_t,
                                 int count, const PlaceWriter<kIsPlain>& writer) {
  const LaneF df;
  const PolynomialLanes<kDegree> x_lanes(x.c), y_lanes(y.c);
  const auto x_base = hn::Set(LaneI(), x.BaseLessBits());
  const auto y_base = hn::Set(LaneI(), y.BaseLessBits());
  auto t = hn::Iota(df, first_t);
  for (int i = 0; i < count; i += kLanes, t = hn::Add(t, hn::Set(df, kLanes))) {
    const auto x_found = hn::Add(FloorAndBits(x_lanes.At(t)), x_base);
    const auto y_found = hn::Add(FloorAndBits(y_lanes.At(t)), y_base);
    writer.Store(Split<true>(x_found, x.last), Split<true>(y_found, y.last), i);
  }
}

// One coordinate of the positions of a segment as parabolas, each of Segment::kParabola elements.
// At the distance j from the middle of these elements, the position is
//   (bend j + slope) j + part + whole
// in 1/256 px from the first knot of the loaded rectangle, plus 1/2.
struct Parabolas {
  static constexpr int kRoom = Segment::kMaxCount / Segment::kParabola + kLanes;
  static constexpr float kReach = 0.5F * (Segment::kParabola - 1);  // largest j
  HWY_ALIGN float bend[kRoom];
  HWY_ALIGN float slope[kRoom];
  HWY_ALIGN float part[kRoom];     // from 0 to 1
  HWY_ALIGN int32_t whole[kRoom];  // less the bits that FloorAndBits() adds

  // Makes `count` parabolas. Returns true if their elements surely need no clamping (Split()).
  //   middle  t in the middle of the elements of the first one
  template <int kDegree>
  HWY_ATTR HWY_INLINE bool Make(const KnotPolynomial& polynomial, float middle, int count) {
    const LaneF df;
    const LaneI di;
    const auto c = [&](int power) HWY_ATTR { return hn::Set(LaneF(), polynomial.c[power]); };
    const auto base_less_bits = hn::Set(di, polynomial.BaseLessBits());
    const auto low = hn::Set(df, static_cast<float>(kOne - polynomial.base));
    const auto high =
        hn::Set(df, static_cast<float>((polynomial.last - 1) * kOne - polynomial.base));
    const auto reach = hn::Set(df, kReach), cubic_slope = hn::Set(df, 0.75F * kReach * kReach);
    const auto last_t = hn::Set(df, middle + static_cast<float>(Segment::kParabola * (count - 1)));
    const auto lanes = hn::Mul(hn::Iota(df, 0), hn::Set(df, Segment::kParabola));
    auto is_inside = hn::Eq(reach, reach);
    for (int k = 0; k < count; k += kLanes) {
      const auto first_t = hn::Set(df, middle + static_cast<float>(Segment::kParabola * k));
      const auto t = hn::Min(hn::Add(lanes, first_t), last_t);
      const auto next = [&t](hn::Vec<LaneF> a, hn::Vec<LaneF> b)
                            HWY_ATTR { return hn::Add(hn::Mul(a, t), b); };
      // The coefficients at t by repeated synthetic division: the value, the slope, half the second
      // derivative, and a sixth of the third one.
      auto v3 = c(3), s3 = c(3), b3 = c(3), third = c(3);
      if constexpr (kDegree == 5) {
        const auto v4 = next(c(5), c(4)), s4 = next(c(5), v4), b4 = next(c(5), s4);
        v3 = next(v4, c(3));
        s3 = next(s4, v3);
        b3 = next(b4, s3);
        third = next(next(c(5), b4), b3);
      }
      const auto v2 = next(v3, c(2)), s2 = next(s3, v2), b2 = next(b3, s2);
      const auto v1 = next(v2, c(1)), s1 = next(s2, v1);
      const auto value = next(v1, c(0));
      const auto slopes = hn::Add(s1, hn::Mul(third, cubic_slope));
      const auto floor = hn::Floor(value);
      hn::Store(b2, df, bend + k);
      hn::Store(slopes, df, slope + k);
      hn::Store(hn::Sub(value, floor), df, part + k);
      hn::Store(hn::Add(hn::ConvertTo(di, floor), base_less_bits), di, whole + k);
      const auto extent = hn::Mul(hn::Add(hn::Mul(hn::Abs(b2), reach), hn::Abs(slopes)), reach);
      is_inside = hn::And(is_inside, hn::And(hn::Ge(hn::Sub(value, extent), low),
                                             hn::Le(hn::Add(value, extent), high)));
    }
    return hn::AllTrue(df, is_inside);
  }

  // Returns the positions of elements on parabola k, at the distances j.
  HWY_ATTR HWY_INLINE hn::Vec<LaneI> At(int k, hn::Vec<LaneF> j) const {
    const LaneF df;
    const auto curve = hn::Add(hn::Mul(hn::Set(df, bend[k]), j), hn::Set(df, slope[k]));
    const auto value = hn::Add(hn::Mul(curve, j), hn::Set(df, part[k]));
    return hn::Add(FloorAndBits(value), hn::Set(LaneI(), whole[k]));
  }
};

// Stores the places of `count` elements by parabolas. The first element is element `first` of the
// first parabola.
template <bool kClamps, bool kIsPlain>
HWY_ATTR void StoreByParabolas(const Parabolas& x, int32_t x_last, const Parabolas& y,
                               int32_t y_last, int first, int count,
                               const PlaceWriter<kIsPlain>& writer) {
  // Stores the elements of parabola k from `from` on, as elements i, i + 1 ... The last vector may
  // reach beyond the last of these; the next parabola overwrites what it stores there.
  const auto store = [&](int k, int from, int i) HWY_ATTR {
    for (int at = 0; at < Segment::kParabola - from; at += kLanes) {
      const auto j = hn::Iota(LaneF(), static_cast<float>(from + at) - Parabolas::kReach);
      writer.Store(Split<kClamps>(x.At(k, j), x_last), Split<kClamps>(y.At(k, j), y_last), i + at);
    }
  };
  store(0, first, 0);
  for (int k = 1, i = Segment::kParabola - first; i < count; ++k, i += Segment::kParabola)
    store(k, 0, i);
}

template <int kDegree, bool kIsPlain>
HWY_ATTR void FindPlacesBy(const Segment& s, int begin, int count, const PixelRect& rect,
                           const GatherSampling& sampling, Places* places) {
  const float first_px = sampling.prefilter.is_even ? 1.0F : 0.5F;
  const KnotPolynomial x(s.x_poly, s.base_x, rect.x_begin, rect.x_end, first_px);
  const KnotPolynomial y(s.y_poly, s.base_y, rect.y_begin, rect.y_end, first_px);
  const PlaceWriter<kIsPlain> writer(rect, sampling, places);
  const float t = s.t_begin + static_cast<float>(begin);
  if (!s.has_parabolas) {
    StoreByPolynomials<kDegree>(x, y, t, count, writer);
    return;
  }
  const int first = (s.x_begin + begin) % Segment::kParabola;
  const float middle = t - static_cast<float>(first) + Parabolas::kReach;
  const int parabolas = (first + count - 1) / Segment::kParabola + 1;
  Parabolas x_parabolas, y_parabolas;
  const bool x_is_inside = x_parabolas.Make<kDegree>(x, middle, parabolas);
  const bool y_is_inside = y_parabolas.Make<kDegree>(y, middle, parabolas);
  if (x_is_inside && y_is_inside)
    StoreByParabolas<false>(x_parabolas, x.last, y_parabolas, y.last, first, count, writer);
  else
    StoreByParabolas<true>(x_parabolas, x.last, y_parabolas, y.last, first, count, writer);
}

// Finds the places of elements [begin, begin + count) of the segment.
//   rect  the pixels that are loaded
inline void FindPlaces(const Segment& s, int begin, int count, const PixelRect& rect,
                       const GatherSampling& sampling, Places* places) {
  const bool is_plain = sampling.filter != PixelFilter::kNearest;
  const auto find = s.is_cubic() ? (is_plain ? FindPlacesBy<3, true> : FindPlacesBy<3, false>)
                                 : (is_plain ? FindPlacesBy<5, true> : FindPlacesBy<5, false>);
  find(s, begin, count, rect, sampling, places);
}

}  // namespace HWY_NAMESPACE
}  // namespace lf
HWY_AFTER_NAMESPACE();

#endif
