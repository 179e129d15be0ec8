// SPDX-License-Identifier: Apache-2.0
// The averaging Haar transform of a plane, one level at a time: thesis 2.5.1, equations 2.20 and
// 2.21, nonstandard decomposition. Internal to this folder.
//
//   analysis, along rows, then along columns:     a = (x + y) / 2    d = (x - y) / 2
//   synthesis, along columns, then along rows:    x = a + d          y = a - d
//
// x and y are neighbours, a is their average and d half of their difference. If the number of
// values is odd, the last one is its own average and has no d. Values are integers in units of
// 2^-kHaarBits, in which five levels of 16-bit pixels are exact.
#pragma once

#include <array>
#include <cstdint>

#include "lf/pixels/codec/wavelet53.h"

namespace lf {

inline constexpr int kHaarBits = 10;

// Splits a plane into the subbands of one level.
//   values  [height][width]
//   bands   indexed by Band (wavelet53.h); [BandHeight][BandWidth] each; a are the low, d the high
//           coefficients
void AnalyzeHaar(const int32_t* values, int width, int height,
                 const std::array<int32_t*, kBands>& bands);

// Restores a plane [height][width] from the subbands of one level.
void SynthesizeHaar(Transform transform, const std::array<const int32_t*, kBands>& bands, int width,
                    int height, int32_t* values);

}  // namespace lf
