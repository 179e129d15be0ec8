// Finds the positions in an LF image that consecutive elements look at. Internal to collection.
// Highway includes this file once for each instruction set.
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
constexpr int kOne = 1 << kWeightBits;  // the whole weight

// Values are taken less this, because one instruction multiplies signed numbers and adds pairs of
// products.
constexpr uint16_t kMiddle = 0x8000;

// The upper left of the four pixels for consecutive elements, and the weights.
struct Places {
  static constexpr int kRoom = Segment::kMaxCount + kLanes;
  HWY_ALIGN int32_t pixel[kRoom];
  HWY_ALIGN uint32_t left_right[kRoom];  // weights of left and right pixels, 16 bits each
  HWY_ALIGN uint32_t lower[kRoom];
  // Only for kMosaic: x % 2 + 2 (y % 2) of the upper left pixel (x, y) of the LF image.
  HWY_ALIGN int32_t phase[kRoom];
};

// An integer between -2^22 and 2^22 is exact in single precision. If it is added to 2^23 + 2^22,
// the last bits of the sum are the integer: this is cheaper than a conversion, which checks for
// overflow.
constexpr float kWhole = 12582912;

// One coordinate: the pixel before the position, counted from `begin`, and the distance from that
// pixel in 1/256.
struct Coordinate {
  hn::Vec<LaneI> pixel;
  hn::Vec<LaneI> weight;
};

// Finds a coordinate within pixels [begin, end).
template <int kDegree>
class CoordinateFinder {
 public:
  HWY_ATTR HWY_INLINE CoordinateFinder(const float (&polynomial)[Segment::kTerms], int32_t base,
                                       int begin, int end)
      : base_((base - begin) * kOne - std::bit_cast<int32_t>(kWhole)), last_(end - begin - 1) {
    // The polynomial counts in 1/256 from the centre of pixel `begin`, plus 1/2 to round half up.
    // Multiplying by 256 is exact.
    for (int power = 0; power < Segment::kTerms; ++power)
      polynomial_[power] = polynomial[power] * kOne;
    polynomial_[0] += 0.5F - 0.5F * kOne;
  }

  HWY_ATTR HWY_INLINE Coordinate Find(hn::Vec<LaneF> t) const {
    const LaneI di;
    const auto place = PolynomialLanes<kDegree>(polynomial_).At(t);
    const auto whole = hn::BitCast(di, hn::Add(hn::Floor(place), hn::Set(LaneF(), kWhole)));
    const auto found = hn::Add(whole, hn::Set(di, base_));
    // A position that rounding has moved beyond the pixels is put on their border.
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
  // kNearest adds half before it cuts the weight to kOne or 0.
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
    if (filter == PixelFilter::kMosaic) {
      const auto odd = [](hn::Vec<LaneI> pixel, int first) HWY_ATTR {
        return hn::And(hn::Xor(pixel, hn::Set(LaneI(), first)), hn::Set(LaneI(), 1));
      };
      hn::Store(hn::Or(odd(x.pixel, rect.x_begin), hn::ShiftLeft<1>(odd(y.pixel, rect.y_begin))),
                di, places->phase + i);
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace lf
HWY_AFTER_NAMESPACE();

#endif
