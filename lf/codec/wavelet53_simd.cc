// The 5/3 transform by rows of vectors, compiled for every instruction set and chosen as the
// program runs (Highway). A level is one pass over its bands: a few rows of coefficients stay in
// the first-level cache between the vertical and the horizontal step.
#include <cstring>
#include <utility>
#include <vector>

#include "lf/codec/wavelet53_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lf/codec/wavelet53_simd.cc"  // NOLINT: as Highway wants it
#include <hwy/foreach_target.h>
// After foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lf {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Rows of a thread, each with slack before and behind it. Their memory is used again.
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

// A row of coefficients as they were coded.
template <class T>
void LoadCoefficients(const CodedBand<T>& band, int row, int count, T* HWY_RESTRICT out) {
  const hn::ScalableTag<T> d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const T* HWY_RESTRICT in = band.values + static_cast<size_t>(row) * count;
  const auto step = hn::Set(d, band.step), one = hn::Set(d, T{1});
  if (band.is_doubled)
    for (int x = 0; x < count; x += lanes)
      hn::StoreU(hn::ShiftRight<1>(hn::Add(hn::Mul(hn::LoadU(d, in + x), step), one)), d, out + x);
  else
    for (int x = 0; x < count; x += lanes)
      hn::StoreU(hn::Mul(hn::LoadU(d, in + x), step), d, out + x);
}

// low - Update(above, below), in place.
template <class T>
void LiftLow(const T* above, const T* below, int count, T* HWY_RESTRICT low) {
  const hn::ScalableTag<T> d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const auto two = hn::Set(d, T{2});
  for (int x = 0; x < count; x += lanes)
    hn::StoreU(hn::Sub(hn::LoadU(d, low + x), Update(Load(above + x), Load(below + x), two)), d,
               low + x);
}

// high + Predicted(above, below).
template <class T>
void LiftHigh(const T* high, const T* above, const T* below, int count, T* HWY_RESTRICT out) {
  const hn::ScalableTag<T> d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  for (int x = 0; x < count; x += lanes)
    hn::StoreU(hn::Add(hn::LoadU(d, high + x), Predicted(Load(above + x), Load(below + x))), d,
               out + x);
}

// One row from its low and its high half. `even` is a row of memory; `out` is written with slack.
template <class T>
void MergeRow(const T* low, T* high, int width, T* even, T* HWY_RESTRICT out) {
  const hn::ScalableTag<T> d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const int low_count = LowCount(width), high_count = HighCount(width);
  if (high_count == 0) {
    out[0] = low[0];
    return;
  }
  high[-1] = high[0];
  if (low_count > high_count) high[high_count] = high[high_count - 1];
  const auto two = hn::Set(d, T{2});
  for (int x = 0; x < low_count; x += lanes)
    hn::StoreU(hn::Sub(Load(low + x), Update(Load(high + x - 1), Load(high + x), two)), d,
               even + x);
  if (low_count == high_count) even[low_count] = even[low_count - 1];
  for (int x = 0; x < low_count; x += lanes) {
    const auto here = Load(even + x);
    const auto odd = hn::Add(Load(high + x), Predicted(here, Load(even + x + 1)));
    hn::StoreInterleaved2(here, odd, d, out + 2 * x);
  }
}

// The half of a level whose bands are both low, or both high, across: what of its rows is known.
template <class T>
struct Half {
  const CodedBand<T>& low;
  const CodedBand<T>& high;
  int count;  // of values in a row
  // High coefficients of this and the last pair of rows, even rows of both, the odd row of the
  // last.
  T *high_now, *high_last, *even_now, *even_last, *odd;
};

// Calls put(y, low, high) for every row of the plane in turn, with what MergeRow() wants.
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
      LoadCoefficients(half.low, i, half.count, half.even_now);
      if (high_rows == 0) continue;
      const bool has_high = i < high_rows;
      if (has_high) LoadCoefficients(half.high, i, half.count, half.high_now);
      LiftLow(i > 0 ? half.high_last : half.high_now, has_high ? half.high_now : half.high_last,
              half.count, half.even_now);
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
  const Rows<T> rows(kRowsOfHalves + 1, LowCount(bands.width));
  SynthesizeRows(bands, rows, [&](int y, const T* low, T* high) {
    MergeRow(low, high, bands.width, rows[kRowsOfHalves],
             values + static_cast<size_t>(y) * bands.width);
  });
}

template <class T, class Pixel>
void SynthesizePixelsOf(const CodedBands<T>& bands, const PixelScale& scale,
                        ImageView<Pixel> pixels) {
  const hn::ScalableTag<T> d;
  const hn::Rebind<Pixel, decltype(d)> d_pixel;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const Rows<T> rows(kRowsOfHalves + 2, bands.width);
  T* const even = rows[kRowsOfHalves];
  T* const row = rows[kRowsOfHalves + 1];
  auto* const narrow = reinterpret_cast<Pixel*>(even);
  const auto half = hn::Set(d, static_cast<T>((1 << scale.fraction_bits) >> 1));
  const auto offset = hn::Set(d, static_cast<T>(scale.offset));
  SynthesizeRows(bands, rows, [&](int y, const T* low, T* high) {
    MergeRow(low, high, bands.width, even, row);
    for (int x = 0; x < bands.width; x += lanes) {
      const auto whole = hn::ShiftRightSame(hn::Add(Load(row + x), half), scale.fraction_bits);
      hn::StoreU(hn::DemoteTo(d_pixel, hn::Add(whole, offset)), d_pixel, narrow + x);
    }
    std::memcpy(pixels.row(y), narrow, sizeof(Pixel) * bands.width);
  });
}

// The halves of a row.
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
  // By half: this even row and the next, the high row and the last one. They go round.
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
