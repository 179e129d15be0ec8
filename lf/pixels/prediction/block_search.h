// SPDX-License-Identifier: Apache-2.0
// Finds the depth of each block and the reference images that predict it best (predict.h).
#pragma once

#include <span>
#include <vector>

#include "lf/core/image.h"
#include "lf/pixels/prediction/predict.h"

namespace lf {

struct SearchSettings {
  int block_bits = 4;  // side of a block, as a binary logarithm
  // Step of the quantiser of the differences that remain, in steps of brightness; 0: they are
  // encoded without loss. Neighbouring blocks get equal depths if the prediction is about as good,
  // because these take fewer bits; the coarser the step, the more it may be worse.
  double step = 0;
};

// Returns the blocks of an image. A block is predicted by all reference images or by one of them.
// Its depth and mask are those with the least sum of absolute differences of brightness, plus the
// estimated cost of the bits that describe them. Depths are searched in pictures of half the size
// first, and then near those that were found. Equal arguments give equal blocks on every machine.
//   brightness  of the image, and of each reference image (brightness.h)
//   warps       one for each reference image, 1 to kMostReferences
BlockField SearchBlocks(const Image<uint8_t>& brightness,
                        std::span<const Image<uint8_t>> references,
                        std::span<const PlaneWarp> warps, const SearchSettings& settings);

}  // namespace lf
