// SPDX-License-Identifier: Apache-2.0
// Structural similarity of two grey pictures.
#pragma once

#include "lf/core/image.h"
#include "lf/core/parallel.h"

namespace lf {

// Windows reach this many pixels beyond their middle.
inline constexpr int kSsimRadius = 5;

// Returns the structural similarity of the window around every pixel, at most 1 (Wang, Bovik,
// Sheikh and Simoncelli 2004, equation 13), with their constants: Gaussian windows of 11 x 11
// pixels with a standard deviation of 1.5, K1 = 0.01, K2 = 0.03. The values of the two pictures are
// in [0, 1]. Windows within kSsimRadius pixels of the border repeat its pixels; the authors leave
// them out.
Image<float> StructuralSimilarity(const Image<float>& a, const Image<float>& b, ThreadPool& pool);

}  // namespace lf
