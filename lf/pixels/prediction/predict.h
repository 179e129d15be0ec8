// SPDX-License-Identifier: Apache-2.0
// Predicts an image from up to four others whose pixels are known, the reference images, in
// integers: the same bits on every instruction set (doc/formats/lf_image.md, "Prediction").
//
// The image is cut into square blocks. Each block has an index of inverse depth (plane_warp.h) and
// the set of reference images that predict it, by their mean. Windows of neighbouring blocks
// overlap, so that no edges appear: weights fall evenly within a quarter of a block on both sides
// of a border. A *cell* is the square between the centres of four blocks; its pixels have the
// weights of these four.
//
// Pixels have 1 to 4 channels, which move together. A mosaic is predicted as the picture of its
// squares of 2 x 2 pixels, with four channels: each colour is predicted from values of the same
// colour.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lf/core/geometry.h"
#include "lf/core/image.h"
#include "lf/pixels/prediction/plane_warp.h"

namespace lf {

inline constexpr int kMostReferences = 4;
inline constexpr int kLeastBlockBits = 3, kMostBlockBits = 5;
inline constexpr int kMostPredictedChannels = 4;

// The blocks of an image, row by row. The first block begins at pixel (0, 0); the last ones of a
// row or column may extend beyond the image.
struct BlockField {
  int block_bits = 4;  // the side of a block is 2^block_bits pixels
  int columns = 0;
  int rows = 0;
  std::vector<uint8_t> depths;  // [rows][columns], 0 to kDepthSteps - 1
  std::vector<uint8_t> masks;   // [rows][columns]; bit r is set if reference image r takes part
  friend bool operator==(const BlockField&, const BlockField&) = default;
};

// Returns the blocks of an image of width x height pixels, all of depth 0 and the given mask.
BlockField MakeBlockField(int width, int height, int block_bits, uint8_t mask);

// How an image is predicted. Warps must be within their limits, depths below kDepthSteps, and masks
// must not be 0 and have no bit for a reference image that does not exist.
struct PredictionPlan {
  std::vector<PlaneWarp> warps;  // one for each reference image, 1 to kMostReferences
  BlockField blocks;
};

// The pixels of a reference image, or those of a part of it.
template <class Pixel>
struct ReferencePart {
  ImageView<const Pixel> pixels;
  int x_begin = 0;  // position of the pixels in the reference image
  int y_begin = 0;
  int width = 0;  // size of the whole reference image
  int height = 0;
};

struct ReferenceSize {
  int width = 0;
  int height = 0;
};

// Returns for each reference image the smallest rectangle that contains all of its pixels that
// predict the pixels `rect`; empty if it predicts none of them.
//   rect  pixels of the image that is predicted
std::vector<PixelRect> NeededOfReferences(const PredictionPlan& plan,
                                          std::span<const ReferenceSize> sizes,
                                          const PixelRect& rect);

// Predicts the pixels `rect` of an image.
//   references  one for each warp; their pixels contain NeededOfReferences(), and have as many
//               channels as `predicted`
//   predicted   [rect.height()][rect.width()][channels]
template <class Pixel>
void PredictReference(const PredictionPlan& plan, std::span<const ReferencePart<Pixel>> references,
                      const PixelRect& rect, ImageView<Pixel> predicted);
// Returns the same bits, with SIMD vectors (Highway).
template <class Pixel>
void Predict(const PredictionPlan& plan, std::span<const ReferencePart<Pixel>> references,
             const PixelRect& rect, ImageView<Pixel> predicted);

}  // namespace lf
