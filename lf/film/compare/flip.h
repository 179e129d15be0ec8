// SPDX-License-Identifier: Apache-2.0
// The difference that a person sees who alternates between two pictures.
#pragma once

#include "lf/core/image.h"
#include "lf/core/parallel.h"

namespace lf {

// Pixels per degree of a display 0.7 m wide with 3840 columns, seen from 0.7 m: 3840 pi / 180.
inline constexpr double kPixelsPerDegree = 67.02064327658226;

// Returns the error FLIP of every pixel, from 0 (no visible difference) to 1 (Andersson, Nilsson,
// Akenine-Moeller, Oskarsson, Astroem and Fairchild, "FLIP: A Difference Evaluator for Alternating
// Images", 2020). The pictures are filtered by the contrast sensitivity of the eye and compared as
// colours (section 4.1); differences of edges and points add to that (section 4.2). Pixels beyond
// the border repeat it.
//   reference, test    linear light in the primaries of sRGB, [height][width][3], within [0, 1]
//   pixels_per_degree  of the visual angle, above 0: how far the observer is from the display
Image<float> FlipErrors(const Image<float>& reference, const Image<float>& test,
                        double pixels_per_degree, ThreadPool& pool);

}  // namespace lf
