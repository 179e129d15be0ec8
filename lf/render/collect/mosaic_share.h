// SPDX-License-Identifier: Apache-2.0
// Finds how strongly mosaics are corrected in a frame (collection/prefilter/mosaic_correction.h).
#pragma once

#include <span>

#include "lf/core/ids.h"
#include "lf/render/collect/frame_lens.h"

namespace lf {

// Returns the share of a random error that is left in the frame's elements, as far as the
// calibration tells it. The error depends on the place of a pixel in the 2 x 2 pixels of the
// mosaic's pattern, and has the mean 0 over the four places. An element whose rays have the share
// W_p of the weights at place p keeps
//   4/3 sum_p (W_p - 1/4)^2
// of its mean square: 1 if all rays come from one place, about 1 / N if N rays of equal weight come
// from random places, and 0 if all four places have the same weight. The result is the mean over
// kSampledElements elements; 1 if none of them has a ray.
//   lenses  the lenses of all instants of the frame, at least one
//   images  the LF images that the frame takes
double MosaicShareOf(std::span<const FrameLens> lenses, std::span<const LfImageId> images);
inline constexpr int kSampledElements = 48;

// Returns the strength of the correction (Prefilter::correction) for a share of the error: 0, none,
// for shares near 1, because demosaicked pictures alone are best as they are. Not all
// of the error that the weights of corrections were made for stays in a frame, and errors of the
// mean do not become as small as they assume; the factor between the shares was chosen with half of
// the rows of doc/quality.md.
int CorrectionFor(double share);
inline constexpr double kShareFactor = 3;

}  // namespace lf
