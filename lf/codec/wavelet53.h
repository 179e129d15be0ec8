// The reversible 5/3 wavelet transform of a plane, one level at a time (Le Gall and Tabatabai 1988;
// as lifting: Calderbank, Daubechies, Sweldens, Yeo 1998). Internal to codec.
//
// Of n values x, (n + 1) / 2 become low ones and n / 2 high ones:
//
//   high[i] = x[2i + 1] - (x[2i] + x[2i + 2] >> 1)
//   low[i]  = x[2i]     + (high[i - 1] + high[i] + 2 >> 2)
//
// Beyond the ends stands what is as far inside of them: x[n] = x[n - 2], high[-1] = high[0]. Rows
// are transformed first, then columns. All arithmetic is that of T, modulo its range, so that the
// synthesis gives back x whatever it is.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "lf/core/image.h"

namespace lf {

// Elements behind the end of every array below that may be read, and written where the array is.
inline constexpr size_t kSlack = 128;

inline int LowCount(int count) { return (count + 1) / 2; }
inline int HighCount(int count) { return count / 2; }

// The bands of a level, by frequency across and down.
enum Band { kLowLow = 0, kHighLow = 1, kLowHigh = 2, kHighHigh = 3 };
inline constexpr int kBands = 4;

inline int BandWidth(Band band, int width) {
  return band == kLowLow || band == kLowHigh ? LowCount(width) : HighCount(width);
}
inline int BandHeight(Band band, int height) {
  return band == kLowLow || band == kHighLow ? LowCount(height) : HighCount(height);
}
inline size_t BandSize(Band band, int width, int height) {
  return static_cast<size_t>(BandWidth(band, width)) * BandHeight(band, height);
}

// A band as it is coded: the coefficient is  v * step,  and that / 2, rounded up at halves, where
// is_doubled.
template <class T>
struct CodedBand {
  const T* values = nullptr;  // [BandHeight][BandWidth]
  T step = 1;
  bool is_doubled = false;
};

template <class T>
struct CodedBands {
  int width = 0;  // of the plane that they are the bands of
  int height = 0;
  std::array<CodedBand<T>, kBands> bands;  // by Band
};

// A plane of pixels from coefficients: (c + half >> fraction_bits) + offset, cut to what the type
// of the pixels holds.
struct PixelScale {
  int fraction_bits = 0;
  int offset = 0;
};

enum class Transform { kReference, kSimd };

// values  [height][width]
//   T       int16_t or int32_t
template <class T>
void Synthesize(Transform transform, const CodedBands<T>& bands, T* values);

// The last level, straight to pixels of one channel. int16_t gives 8 bits, int32_t both.
template <class T, class Pixel>
void SynthesizePixels(Transform transform, const CodedBands<T>& bands, const PixelScale& scale,
                      ImageView<Pixel> pixels);

// values  [height][width], and slack
// bands   [BandHeight][BandWidth] each, and slack
void Analyze(Transform transform, const int32_t* values, int width, int height,
             const std::array<int32_t*, kBands>& bands);

// How large the synthesis makes an error of 1 in one coefficient: the Euclidean norm, along one
// dimension. is_high: whether its band is high at the deepest level, then whether that of what it
// becomes is at the next one, and so on to the plane itself.
double SynthesisNorm(const std::vector<bool>& is_high);

}  // namespace lf
