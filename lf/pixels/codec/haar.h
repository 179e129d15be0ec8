// The averaging Haar transform of a plane, one level at a time: thesis 2.5.1, equations 2.20 and
// 2.21, nonstandard decomposition. Internal to this folder.
//
//   analysis, along rows, then along columns:     a = (x + y) / 2    d = (x - y) / 2
//   synthesis, along columns, then along rows:    x = a + d          y = a - d
//
// x and y are neighbours. If the number of values is odd, the last one is its own average and has
// no d. Values are integers in units of 1 / 2^kHaarBits, in which five levels of 16-bit pixels are
// exact.
#pragma once

#include <array>
#include <cstdint>

#include "lf/pixels/codec/wavelet53.h"

namespace lf {

inline constexpr int kHaarBits = 10;

// values  [height][width]
// bands   as in wavelet53.h; "high" is d
void AnalyzeHaar(const int32_t* values, int width, int height,
                 const std::array<int32_t*, kBands>& bands);

void SynthesizeHaar(Transform transform, const std::array<const int32_t*, kBands>& bands, int width,
                    int height, int32_t* values);

}  // namespace lf
