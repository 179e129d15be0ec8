// SPDX-License-Identifier: Apache-2.0
// Converts colours to brightness and two colour differences, in integers and without loss: YCoCg-R
// (Malvar and Sullivan 2003). Internal to this folder.
//
//   co = r - b    t = b + (co >> 1)    cg = g - t    y = t + (cg >> 1)
//
// r, g, b are the colours, y is the brightness, and co and cg are the colour differences.
#pragma once

#include <array>
#include <cstdint>

#include "lf/pixels/codec/wavelet53.h"

namespace lf {

// The components are y, cg, co. kRgbNorms holds, for each component, the Euclidean norm of the
// error in R, G, B that an error of 1 in the component causes.
inline constexpr int kRgbComponents = 3;
inline constexpr std::array<double, kRgbComponents> kRgbNorms = {1.7320508, 0.8660254, 0.7071068};

// Converts in place: red, green, blue become y, cg, co.
void SeparateColours(int32_t* red_y, int32_t* green_cg, int32_t* blue_co, size_t count);

// Makes pixels of three channels from the components, scaled as PixelScale (wavelet53.h) states.
// Rows of the components are as wide as rows of the pixels, and kSlack elements (wavelet53.h) must
// follow the last row.
template <class T, class Pixel>
void MergeColours(Transform transform, const std::array<const T*, kRgbComponents>& components,
                  const PixelScale& scale, ImageView<Pixel> pixels);

}  // namespace lf
