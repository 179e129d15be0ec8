// SPDX-License-Identifier: Apache-2.0
// The two implementations of the functions that wavelet53.h declares. Internal to this folder.
#pragma once

#include <array>

#include "lf/pixels/codec/wavelet53.h"

namespace lf {

// The reference implementations.
template <class T>
void SynthesizeReference(const CodedBands<T>& bands, T* values);
template <class T, class Pixel>
void SynthesizePixelsReference(const CodedBands<T>& bands, const PixelScale& scale,
                               ImageView<Pixel> pixels);
void AnalyzeReference(const int32_t* values, int width, int height,
                      const std::array<int32_t*, kBands>& bands);

// The implementations with SIMD vectors (Highway).
template <class T>
void SynthesizeSimd(const CodedBands<T>& bands, T* values);
template <class T, class Pixel>
void SynthesizePixelsSimd(const CodedBands<T>& bands, const PixelScale& scale,
                          ImageView<Pixel> pixels);
void AnalyzeSimd(const int32_t* values, int width, int height,
                 const std::array<int32_t*, kBands>& bands);

}  // namespace lf
