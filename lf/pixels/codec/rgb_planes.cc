// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/codec/rgb_planes.h"

#include <algorithm>
#include <limits>
#include <type_traits>

// MergeColours() with SIMD vectors, compiled for every instruction set; the program chooses one at
// run time (Highway).
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lf/pixels/codec/rgb_planes.cc"  // NOLINT: Highway reads this macro
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lf {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class T, class Pixel>
void MergeRow(const std::array<const T*, kRgbComponents>& components, const PixelScale& scale,
              int width, Pixel* HWY_RESTRICT out) {
  const hn::ScalableTag<T> d;
  const hn::Rebind<Pixel, decltype(d)> d_pixel;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const auto half = hn::Set(d, static_cast<T>((1 << scale.fraction_bits) >> 1));
  const auto offset = hn::Set(d, static_cast<T>(scale.offset));
  const auto pixel = [&](auto value, auto added) {
    const auto whole = hn::ShiftRightSame(hn::Add(value, half), scale.fraction_bits);
    return hn::DemoteTo(d_pixel, hn::Add(whole, added));
  };
  const auto store = [&](auto red, auto green, auto blue, Pixel* to) {
    if (!scale.adds) {
      hn::StoreInterleaved3(pixel(red, offset), pixel(green, offset), pixel(blue, offset), d_pixel,
                            to);
      return;
    }
    auto red_before = hn::Zero(d_pixel), green_before = red_before, blue_before = red_before;
    hn::LoadInterleaved3(d_pixel, to, red_before, green_before, blue_before);
    hn::StoreInterleaved3(pixel(red, hn::PromoteTo(d, red_before)),
                          pixel(green, hn::PromoteTo(d, green_before)),
                          pixel(blue, hn::PromoteTo(d, blue_before)), d_pixel, to);
  };
  for (int x = 0; x < width; x += lanes) {
    const auto y = hn::LoadU(d, components[0] + x), cg = hn::LoadU(d, components[1] + x);
    const auto co = hn::LoadU(d, components[2] + x);
    const auto t = hn::Sub(y, hn::ShiftRight<1>(cg));
    const auto green = hn::Add(cg, t);
    const auto blue = hn::Sub(t, hn::ShiftRight<1>(co));
    const auto red = hn::Add(blue, co);
    if (x + lanes <= width) {
      store(red, green, blue, out + 3 * x);
      continue;
    }
    HWY_ALIGN Pixel last[3 * kSlack];
    std::copy_n(out + 3 * x, 3 * (width - x), last);
    store(red, green, blue, last);
    std::copy_n(last, 3 * (width - x), out + 3 * x);
  }
}

void Merge8Of16(const std::array<const int16_t*, kRgbComponents>& components,
                const PixelScale& scale, int width, uint8_t* out) {
  MergeRow(components, scale, width, out);
}
void Merge8Of32(const std::array<const int32_t*, kRgbComponents>& components,
                const PixelScale& scale, int width, uint8_t* out) {
  MergeRow(components, scale, width, out);
}
void Merge16Of32(const std::array<const int32_t*, kRgbComponents>& components,
                 const PixelScale& scale, int width, uint16_t* out) {
  MergeRow(components, scale, width, out);
}

}  // namespace HWY_NAMESPACE
}  // namespace lf
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lf {
namespace {

HWY_EXPORT(Merge8Of16);
HWY_EXPORT(Merge8Of32);
HWY_EXPORT(Merge16Of32);

void MergeRowSimd(const std::array<const int16_t*, kRgbComponents>& components,
                  const PixelScale& scale, int width, uint8_t* out) {
  HWY_DYNAMIC_DISPATCH(Merge8Of16)(components, scale, width, out);
}
void MergeRowSimd(const std::array<const int32_t*, kRgbComponents>& components,
                  const PixelScale& scale, int width, uint8_t* out) {
  HWY_DYNAMIC_DISPATCH(Merge8Of32)(components, scale, width, out);
}
void MergeRowSimd(const std::array<const int32_t*, kRgbComponents>& components,
                  const PixelScale& scale, int width, uint16_t* out) {
  HWY_DYNAMIC_DISPATCH(Merge16Of32)(components, scale, width, out);
}

// Sum() and Difference() add and subtract modulo the range of T, as SIMD instructions do.
template <class T>
T Sum(T a, T b) {
  using Unsigned = std::make_unsigned_t<T>;
  return static_cast<T>(static_cast<Unsigned>(static_cast<Unsigned>(a) + static_cast<Unsigned>(b)));
}
template <class T>
T Difference(T a, T b) {
  using Unsigned = std::make_unsigned_t<T>;
  return static_cast<T>(static_cast<Unsigned>(static_cast<Unsigned>(a) - static_cast<Unsigned>(b)));
}

template <class T, class Pixel>
void MergeRowReference(const std::array<const T*, kRgbComponents>& components,
                       const PixelScale& scale, int width, Pixel* out) {
  const T half = static_cast<T>((1 << scale.fraction_bits) >> 1);
  const auto set = [&](T value, Pixel* to) {
    const T whole = static_cast<T>(Sum(value, half) >> scale.fraction_bits);
    const T offset = static_cast<T>(scale.adds ? *to : scale.offset);
    *to = static_cast<Pixel>(
        std::clamp<int64_t>(Sum(whole, offset), 0, std::numeric_limits<Pixel>::max()));
  };
  for (int x = 0; x < width; ++x) {
    const T cg = components[1][x], co = components[2][x];
    const T t = Difference(components[0][x], static_cast<T>(cg >> 1));
    const T blue = Difference(t, static_cast<T>(co >> 1));
    set(Sum(blue, co), out + 3 * x);
    set(Sum(cg, t), out + 3 * x + 1);
    set(blue, out + 3 * x + 2);
  }
}

}  // namespace

void SeparateColours(int32_t* red_y, int32_t* green_cg, int32_t* blue_co, size_t count) {
  for (size_t i = 0; i < count; ++i) {
    const int32_t co = red_y[i] - blue_co[i];
    const int32_t t = blue_co[i] + (co >> 1);
    const int32_t cg = green_cg[i] - t;
    red_y[i] = t + (cg >> 1);
    green_cg[i] = cg;
    blue_co[i] = co;
  }
}

template <class T, class Pixel>
void MergeColours(Transform transform, const std::array<const T*, kRgbComponents>& components,
                  const PixelScale& scale, ImageView<Pixel> pixels) {
  for (int y = 0; y < pixels.height; ++y) {
    std::array<const T*, kRgbComponents> rows = components;
    for (const T*& row : rows) row += static_cast<size_t>(y) * pixels.width;
    if (transform == Transform::kReference)
      MergeRowReference(rows, scale, pixels.width, pixels.row(y));
    else
      MergeRowSimd(rows, scale, pixels.width, pixels.row(y));
  }
}
template void MergeColours(Transform, const std::array<const int16_t*, kRgbComponents>&,
                           const PixelScale&, ImageView<uint8_t>);
template void MergeColours(Transform, const std::array<const int32_t*, kRgbComponents>&,
                           const PixelScale&, ImageView<uint8_t>);
template void MergeColours(Transform, const std::array<const int32_t*, kRgbComponents>&,
                           const PixelScale&, ImageView<uint16_t>);

}  // namespace lf
#endif  // HWY_ONCE
