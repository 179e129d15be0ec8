// SPDX-License-Identifier: Apache-2.0
// The reversible 5/3 wavelet transform of a plane, one level at a time (Le Gall and Tabatabai 1988;
// as lifting: Calderbank, Daubechies, Sweldens, Yeo 1998). Internal to this folder.
//
// The transform converts n values x to (n + 1) / 2 low and n / 2 high coefficients:
//
//   high[i] = x[2i + 1] - (x[2i] + x[2i + 2] >> 1)
//   low[i]  = x[2i]     + (high[i - 1] + high[i] + 2 >> 2)
//
// Values beyond the ends are mirrored: x[n] = x[n - 2], high[-1] = high[0] and, for odd n,
// high[n / 2] = high[n / 2 - 1]. A single value is its own low coefficient. Rows are transformed
// first, then columns. All arithmetic is in the type T of the values, modulo its range, so that the
// inverse transform (synthesis) restores any x exactly.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "lf/core/image.h"

namespace lf {

// Slack: number of additional elements that each array needs behind its end if it is passed to the
// functions below. The functions may read these elements, and may overwrite them if the array is an
// output.
inline constexpr size_t kSlack = 128;

inline int LowCount(int count) { return (count + 1) / 2; }
inline int HighCount(int count) { return count / 2; }

// The subbands of a level. The first word of a name is the frequency along rows, the second the
// frequency along columns.
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

// A subband as it is encoded. A value v stands for the coefficient v * step, or for half of v *
// step, with halves rounded up, if is_doubled is true.
template <class T>
struct CodedBand {
  const T* values = nullptr;  // [BandHeight][BandWidth]
  T step = 1;
  bool is_doubled = false;
};

template <class T>
struct CodedBands {
  int width = 0;                           // width of the plane that was split into these subbands
  int height = 0;                          // height of this plane
  std::array<CodedBand<T>, kBands> bands;  // indexed by Band
};

// How a coefficient c becomes a pixel: (c + half >> fraction_bits) + offset, clipped to the range
// of the pixel type, where half is 2^fraction_bits / 2, rounded down.
struct PixelScale {
  int fraction_bits = 0;
  int offset = 0;
  // True if coefficients are differences to a prediction. Before, the pixels then hold the
  // prediction, which takes the place of `offset`.
  bool adds = false;
};

enum class Transform { kReference, kSimd };

// Restores a plane from the subbands of one level.
//   values  [height][width], and kSlack more elements
//   T       int16_t or int32_t
template <class T>
void Synthesize(Transform transform, const CodedBands<T>& bands, T* values);

// Restores pixels of one channel directly from the subbands of the finest level. T is int16_t or
// int32_t for 8-bit pixels, and int32_t for 16-bit pixels.
template <class T, class Pixel>
void SynthesizePixels(Transform transform, const CodedBands<T>& bands, const PixelScale& scale,
                      ImageView<Pixel> pixels);

// Splits a plane into the subbands of one level.
//   values  [height][width], and kSlack more elements
//   bands   indexed by Band; [BandHeight][BandWidth] each, and kSlack more elements
void Analyze(Transform transform, const int32_t* values, int width, int height,
             const std::array<int32_t*, kBands>& bands);

// Returns the Euclidean norm, along one dimension, of the error in the restored values that an
// error of 1 in one coefficient causes. is_high has one entry for each level of the synthesis, from
// the coefficient's level to the finest. An entry is true if the coefficient, or what the previous
// level restored from it, is in the high subband of its level.
double SynthesisNorm(const std::vector<bool>& is_high);

}  // namespace lf
