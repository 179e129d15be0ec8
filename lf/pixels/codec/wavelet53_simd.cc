// SPDX-License-Identifier: Apache-2.0
// The 5/3 transform with SIMD vectors along rows, compiled for every instruction set; the program
// chooses one at run time (Highway). A level is one pass over its subbands: a few rows of
// coefficients stay in the first-level cache between the vertical and the horizontal step.
#include <cstring>
#include <utility>
#include <vector>

#include "lf/pixels/codec/wavelet53_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lf/pixels/codec/wavelet53_simd.cc"  // NOLINT: Highway reads this macro
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lf {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Rows of values in memory that a thread reuses, with slack at both ends of each row.
template <class T>
class Rows {
 public:
  Rows(int count, int width) : stride_((static_cast<size_t>(width) + 2 * kSlack + 63) / 64 * 64) {
    static thread_local std::vector<T> memory;
    if (memory.size() < stride_ * count) memory.resize(stride_ * count);
    begin_ = memory.data() + kSlack;
  }
  T* operator[](int row) const { return begin_ + stride_ * row; }

 private:
  size_t stride_;
  T* begin_;
};

template <class T>
HWY_INLINE hn::VFromD<hn::ScalableTag<T>> Load(const T* from) {
  return hn::LoadU(hn::ScalableTag<T>(), from);
}

template <class V>
HWY_INLINE V Predicted(V left, V right) {
  return hn::ShiftRight<1>(hn::Add(left, right));
}
template <class V>
HWY_INLINE V Update(V left, V right, V two) {
  return hn::ShiftRight<2>(hn::Add(hn::Add(left, right), two));
}

// Coefficients of a row, converted from their encoded values. Usage: Coefficients(band, row,
// count).At(x), where x is a multiple of the number of lanes.
template <class T>
class Coefficients {
 public:
  using V = hn::VFromD<hn::ScalableTag<T>>;

  Coefficients(const CodedBand<T>& band, int row, int count)
      : values_(band.values + static_cast<size_t>(row) * count),
        step_(hn::Set(hn::ScalableTag<T>(), band.step)),
        half_(hn::Set(hn::ScalableTag<T>(), static_cast<T>(band.is_doubled ? 1 : 0))),
        shift_(band.is_doubled ? 1 : 0) {}
  HWY_INLINE V At(int x) const {
    const V scaled = hn::Mul(hn::LoadU(hn::ScalableTag<T>(), values_ + x), step_);
    return hn::ShiftRightSame(hn::Add(scaled, half_), shift_);
  }

 private:
  const T* values_;
  V step_, half_;
  int shift_;
};

template <class T>
void LoadRow(const CodedBand<T>& band, int row, int count, T* HWY_RESTRICT out) {
  const hn::ScalableTag<T> d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const Coefficients<T> coefficients(band, row, count);
  for (int x = 0; x < count; x += lanes) hn::StoreU(coefficients.At(x), d, out + x);
}

// Computes an even row of values: low - Update(above, below), where `low` is a row of the low
// subband, and `above` and `below` are the rows of high coefficients on either side of it.
template <class T>
void LoadEvenRow(const CodedBand<T>& band, int row, int count, const T* above, const T* below,
                 T* HWY_RESTRICT out) {
  const hn::ScalableTag<T> d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const Coefficients<T> low(band, row, count);
  const auto two = hn::Set(d, T{2});
  for (int x = 0; x < count; x += lanes)
    hn::StoreU(hn::Sub(low.At(x), Update(Load(above + x), Load(below + x), two)), d, out + x);
}

// Computes an odd row of values: high + Predicted(above, below), where `above` and `below` are the
// even rows on either side of it.
template <class T>
void LiftHigh(const T* high, const T* above, const T* below, int count, T* HWY_RESTRICT out) {
  const hn::ScalableTag<T> d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  for (int x = 0; x < count; x += lanes)
    hn::StoreU(hn::Add(hn::LoadU(d, high + x), Predicted(Load(above + x), Load(below + x))), d,
               out + x);
}

// Merges the low and the high half of a row, and writes into their slack. Calls store(x, even, odd)
// for vectors of the merged values at positions 2x, 2x + 2, ... and 2x + 1, 2x + 3, ..., including
// some beyond the end.
template <class T, class Store>
HWY_INLINE void MergeRow(T* low, T* high, int width, const Store& store) {
  const hn::ScalableTag<T> d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const int low_count = LowCount(width), high_count = HighCount(width);
  if (high_count == 0) {
    store(0, Load(low), Load(low));
    return;
  }
  // If the width is even, this value of high[high_count] makes the even value beyond the end of the
  // row equal to the last even value. If the width is odd, it is the last high coefficient,
  // mirrored.
  high[-1] = high[0];
  high[high_count] = low_count > high_count ? high[high_count - 1] : high[high_count - 2];
  low[low_count] = low[low_count - 1];
  const auto two = hn::Set(d, T{2});
  for (int x = 0; x < low_count; x += lanes) {
    const auto here = Load(high + x);
    const auto even = hn::Sub(Load(low + x), Update(Load(high + x - 1), here, two));
    const auto next = hn::Sub(Load(low + x + 1), Update(here, Load(high + x + 1), two));
    store(x, even, hn::Add(here, Predicted(even, next)));
  }
}

// State of one half of a level: the two subbands that are both low, or both high, across.
template <class T>
struct Half {
  const CodedBand<T>& low;
  const CodedBand<T>& high;
  int count;  // number of values in a row
  // The high coefficients of the current and the previous pair of rows, the even rows of both
  // pairs, and the odd row of the previous pair.
  T *high_now, *high_last, *even_now, *even_last, *odd;
};

// Calls put(y, low, high) for every row y of the plane in turn; `low` and `high` are the halves of
// row y, as MergeRow() takes them.
template <class T, class Put>
void SynthesizeRows(const CodedBands<T>& bands, const Rows<T>& rows, const Put& put) {
  const int low_rows = LowCount(bands.height), high_rows = HighCount(bands.height);
  Half<T> halves[2] = {{bands.bands[kLowLow], bands.bands[kLowHigh], LowCount(bands.width), rows[0],
                        rows[1], rows[2], rows[3], rows[4]},
                       {bands.bands[kHighLow], bands.bands[kHighHigh], HighCount(bands.width),
                        rows[5], rows[6], rows[7], rows[8], rows[9]}};
  for (int i = 0; i < low_rows; ++i) {
    for (Half<T>& half : halves) {
      std::swap(half.high_now, half.high_last);
      std::swap(half.even_now, half.even_last);
      if (high_rows == 0) {
        LoadRow(half.low, i, half.count, half.even_now);
        continue;
      }
      const bool has_high = i < high_rows;
      if (has_high) LoadRow(half.high, i, half.count, half.high_now);
      LoadEvenRow(half.low, i, half.count, i > 0 ? half.high_last : half.high_now,
                  has_high ? half.high_now : half.high_last, half.even_now);
      if (i > 0) LiftHigh(half.high_last, half.even_last, half.even_now, half.count, half.odd);
    }
    if (i > 0) put(2 * i - 1, halves[0].odd, halves[1].odd);
    put(2 * i, halves[0].even_now, halves[1].even_now);
  }
  if (low_rows > high_rows) return;
  for (Half<T>& half : halves)
    LiftHigh(half.high_now, half.even_now, half.even_now, half.count, half.odd);
  put(bands.height - 1, halves[0].odd, halves[1].odd);
}

constexpr int kRowsOfHalves = 10;

template <class T>
void SynthesizeOf(const CodedBands<T>& bands, T* values) {
  const hn::ScalableTag<T> d;
  SynthesizeRows(bands, Rows<T>(kRowsOfHalves, LowCount(bands.width)), [&](int y, T* low, T* high) {
    T* const row = values + static_cast<size_t>(y) * bands.width;
    MergeRow(low, high, bands.width,
             [&](int x, auto even, auto odd) { hn::StoreInterleaved2(even, odd, d, row + 2 * x); });
  });
}

template <class T, class Pixel>
void SynthesizePixelsOf(const CodedBands<T>& bands, const PixelScale& scale,
                        ImageView<Pixel> pixels) {
  const hn::ScalableTag<T> d;
  const hn::Rebind<Pixel, decltype(d)> d_pixel;
  const Rows<T> rows(kRowsOfHalves + 1, bands.width);
  // Vectors write beyond the end of a row, where another tile of the image begins. Each row is
  // therefore computed in scratch memory and then copied.
  auto* const row = reinterpret_cast<Pixel*>(rows[kRowsOfHalves]);
  const auto half = hn::Set(d, static_cast<T>((1 << scale.fraction_bits) >> 1));
  const auto offset = hn::Set(d, static_cast<T>(scale.offset));
  const auto pixel = [&](auto value, auto added) {
    const auto whole = hn::ShiftRightSame(hn::Add(value, half), scale.fraction_bits);
    return hn::DemoteTo(d_pixel, hn::Add(whole, added));
  };
  SynthesizeRows(bands, rows, [&](int y, T* low, T* high) {
    if (scale.adds) {
      std::memcpy(row, pixels.row(y), sizeof(Pixel) * bands.width);
      MergeRow(low, high, bands.width, [&](int x, auto even, auto odd) {
        auto even_before = hn::Zero(d_pixel), odd_before = hn::Zero(d_pixel);
        hn::LoadInterleaved2(d_pixel, row + 2 * x, even_before, odd_before);
        hn::StoreInterleaved2(pixel(even, hn::PromoteTo(d, even_before)),
                              pixel(odd, hn::PromoteTo(d, odd_before)), d_pixel, row + 2 * x);
      });
    } else {
      MergeRow(low, high, bands.width, [&](int x, auto even, auto odd) {
        hn::StoreInterleaved2(pixel(even, offset), pixel(odd, offset), d_pixel, row + 2 * x);
      });
    }
    std::memcpy(pixels.row(y), row, sizeof(Pixel) * bands.width);
  });
}

// Splits a row into its low and its high coefficients. `even` is scratch memory for the even
// values.
void SplitRow(const int32_t* row, int width, int32_t* even, int32_t* HWY_RESTRICT low,
              int32_t* HWY_RESTRICT high) {
  const hn::ScalableTag<int32_t> d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const int low_count = LowCount(width), high_count = HighCount(width);
  if (high_count == 0) {
    low[0] = row[0];
    return;
  }
  for (int x = 0; x < low_count; x += lanes) {
    auto here = hn::Zero(d), odd = hn::Zero(d);
    hn::LoadInterleaved2(d, row + 2 * x, here, odd);
    hn::StoreU(here, d, even + x);
    hn::StoreU(odd, d, high + x);
  }
  if (low_count == high_count) even[low_count] = even[low_count - 1];
  for (int x = 0; x < high_count; x += lanes)
    hn::StoreU(hn::Sub(Load(high + x), Predicted(Load(even + x), Load(even + x + 1))), d, high + x);
  high[-1] = high[0];
  if (low_count > high_count) high[high_count] = high[high_count - 1];
  const auto two = hn::Set(d, 2);
  for (int x = 0; x < low_count; x += lanes)
    hn::StoreU(hn::Add(Load(even + x), Update(Load(high + x - 1), Load(high + x), two)), d,
               low + x);
}

void CopyRow(const int32_t* from, int count, int32_t* to) {
  std::memcpy(to, from, sizeof(int32_t) * count);
}

void AnalyzeOf(const int32_t* values, int width, int height,
               const std::array<int32_t*, kBands>& bands) {
  const hn::ScalableTag<int32_t> d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const int low_rows = LowCount(height), high_rows = HighCount(height);
  // Rows of each half: the current and the next even row, the current and the previous high row.
  // Pointers to them are swapped.
  const Rows<int32_t> rows(9, LowCount(width));
  struct Side {
    Band low, high;
    int count;
    int32_t *even, *next, *high_now, *high_last;
  };
  Side sides[2] = {{kLowLow, kLowHigh, LowCount(width), rows[0], rows[1], rows[2], rows[3]},
                   {kHighLow, kHighHigh, HighCount(width), rows[4], rows[5], rows[6], rows[7]}};
  int32_t* const split = rows[8];
  const auto load = [&](int y, int32_t* Side::*low_half, int32_t* Side::*high_half) {
    SplitRow(values + static_cast<size_t>(y) * width, width, split, sides[0].*low_half,
             sides[1].*high_half);
  };
  const auto two = hn::Set(d, 2);
  load(0, &Side::even, &Side::even);
  for (int i = 0; i < low_rows; ++i) {
    const bool has_high = i < high_rows;
    if (has_high) {
      for (Side& side : sides) std::swap(side.high_now, side.high_last);
      load(2 * i + 1, &Side::high_now, &Side::high_now);
      const bool has_next = 2 * i + 2 < height;
      if (has_next) load(2 * i + 2, &Side::next, &Side::next);
      for (Side& side : sides) {
        const int32_t* const below = has_next ? side.next : side.even;
        for (int x = 0; x < side.count; x += lanes)
          hn::StoreU(
              hn::Sub(Load(side.high_now + x), Predicted(Load(side.even + x), Load(below + x))), d,
              side.high_now + x);
        CopyRow(side.high_now, side.count, bands[side.high] + static_cast<size_t>(i) * side.count);
      }
    }
    for (Side& side : sides) {
      int32_t* const low = side.even;
      if (high_rows > 0) {
        const int32_t* const above = i > 0 && has_high ? side.high_last : side.high_now;
        for (int x = 0; x < side.count; x += lanes)
          hn::StoreU(hn::Add(Load(low + x), Update(Load(above + x), Load(side.high_now + x), two)),
                     d, low + x);
      }
      CopyRow(low, side.count, bands[side.low] + static_cast<size_t>(i) * side.count);
      std::swap(side.even, side.next);
    }
  }
}

void Synthesize16(const CodedBands<int16_t>& bands, int16_t* values) {
  SynthesizeOf(bands, values);
}
void Synthesize32(const CodedBands<int32_t>& bands, int32_t* values) {
  SynthesizeOf(bands, values);
}
void Pixels8Of16(const CodedBands<int16_t>& bands, const PixelScale& scale,
                 ImageView<uint8_t> pixels) {
  SynthesizePixelsOf(bands, scale, pixels);
}
void Pixels8Of32(const CodedBands<int32_t>& bands, const PixelScale& scale,
                 ImageView<uint8_t> pixels) {
  SynthesizePixelsOf(bands, scale, pixels);
}
void Pixels16Of32(const CodedBands<int32_t>& bands, const PixelScale& scale,
                  ImageView<uint16_t> pixels) {
  SynthesizePixelsOf(bands, scale, pixels);
}

}  // namespace HWY_NAMESPACE
}  // namespace lf
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lf {

HWY_EXPORT(Synthesize16);
HWY_EXPORT(Synthesize32);
HWY_EXPORT(Pixels8Of16);
HWY_EXPORT(Pixels8Of32);
HWY_EXPORT(Pixels16Of32);
HWY_EXPORT(AnalyzeOf);

template <>
void SynthesizeSimd(const CodedBands<int16_t>& bands, int16_t* values) {
  HWY_DYNAMIC_DISPATCH(Synthesize16)(bands, values);
}
template <>
void SynthesizeSimd(const CodedBands<int32_t>& bands, int32_t* values) {
  HWY_DYNAMIC_DISPATCH(Synthesize32)(bands, values);
}
template <>
void SynthesizePixelsSimd(const CodedBands<int16_t>& bands, const PixelScale& scale,
                          ImageView<uint8_t> pixels) {
  HWY_DYNAMIC_DISPATCH(Pixels8Of16)(bands, scale, pixels);
}
template <>
void SynthesizePixelsSimd(const CodedBands<int32_t>& bands, const PixelScale& scale,
                          ImageView<uint8_t> pixels) {
  HWY_DYNAMIC_DISPATCH(Pixels8Of32)(bands, scale, pixels);
}
template <>
void SynthesizePixelsSimd(const CodedBands<int32_t>& bands, const PixelScale& scale,
                          ImageView<uint16_t> pixels) {
  HWY_DYNAMIC_DISPATCH(Pixels16Of32)(bands, scale, pixels);
}
void AnalyzeSimd(const int32_t* values, int width, int height,
                 const std::array<int32_t*, kBands>& bands) {
  HWY_DYNAMIC_DISPATCH(AnalyzeOf)(values, width, height, bands);
}

template <class T>
void Synthesize(Transform transform, const CodedBands<T>& bands, T* values) {
  if (transform == Transform::kReference)
    SynthesizeReference(bands, values);
  else
    SynthesizeSimd(bands, values);
}
template void Synthesize(Transform, const CodedBands<int16_t>&, int16_t*);
template void Synthesize(Transform, const CodedBands<int32_t>&, int32_t*);

template <class T, class Pixel>
void SynthesizePixels(Transform transform, const CodedBands<T>& bands, const PixelScale& scale,
                      ImageView<Pixel> pixels) {
  if (transform == Transform::kReference)
    SynthesizePixelsReference(bands, scale, pixels);
  else
    SynthesizePixelsSimd(bands, scale, pixels);
}
template void SynthesizePixels(Transform, const CodedBands<int16_t>&, const PixelScale&,
                               ImageView<uint8_t>);
template void SynthesizePixels(Transform, const CodedBands<int32_t>&, const PixelScale&,
                               ImageView<uint8_t>);
template void SynthesizePixels(Transform, const CodedBands<int32_t>&, const PixelScale&,
                               ImageView<uint16_t>);

void Analyze(Transform transform, const int32_t* values, int width, int height,
             const std::array<int32_t*, kBands>& bands) {
  if (transform == Transform::kReference)
    AnalyzeReference(values, width, height, bands);
  else
    AnalyzeSimd(values, width, height, bands);
}

}  // namespace lf
#endif  // HWY_ONCE
