// SPDX-License-Identifier: Apache-2.0
// Encodes and decodes one tile of an image by wavelets, in the default and the lossless profile.
// Internal to this folder.
//
// A mosaic is transformed once as a single plane, because this separates brightness and colours
// better than planes of equal colour do. Its four subbands are the components, which are
// transformed further. A grey image has one component, a colour image three (rgb_planes.h).
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lf/pixels/codec/code_head.h"
#include "lf/pixels/codec/wavelet53.h"

namespace lf {

// Sets fraction_bits and steps of the head, as its profile and settings.threshold demand.
void SetSteps(const CodecSettings& settings, CodeHead* head);

// The quantised coefficients of a tile, in one stream for each component and resolution. Resolution
// 0 is the approximation, the others are details from the coarsest level to the finest.
struct QuantizedTile {
  int width = 0;  // in pixels
  int height = 0;
  std::vector<std::vector<int32_t>> streams;  // index: component * (1 + levels) + resolution
  int32_t largest = 0;                        // largest magnitude of all coefficients before
                                              // quantisation
};

// Returns the coefficients of a tile.
//   prediction  of the size of `pixels` if the head says that the image is predicted: coefficients
//               are those of the pixels less their prediction; otherwise empty
template <class Pixel>
QuantizedTile QuantizeTile(Transform transform, const CodeHead& head, ImageView<const Pixel> pixels,
                           ImageView<const Pixel> prediction);

// Returns true if two bytes can hold all coefficients whose magnitude is at most `largest`, and
// also the sums of two values that occur during the synthesis.
bool FitsInTwoBytes(int32_t largest);

// Returns the encoded coefficients of one resolution of a tile.
std::string CodeOfSection(const CodeHead& head, const QuantizedTile& tile, int resolution);

// Decodes the pixels of a tile from its sections, which are ordered by resolution. Before, the
// pixels must hold the prediction if the head says that the image is predicted. Returns false if a
// section is damaged.
template <class Pixel>
[[nodiscard]] bool DecodeWaveletTile(Transform transform, const CodeHead& head,
                                     std::span<std::string_view> sections, ImageView<Pixel> pixels);

// Decodes a smaller picture of a tile from its first sections, which are those of the resolutions
// 0, 1, ..., sections.size() - 1: the low subband of the next level. Its sample (x, y) belongs to
// the pixel (x, y) * 2^n of the tile, where n is the number of resolutions that are left out, and
// one more for a mosaic, whose pixels are then squares of 2 x 2. Returns false if a section is
// damaged.
//   tile_width, tile_height  size of the tile in pixels
//   pixels  [height][width][1], or [3] for RGB, or [4] for a mosaic: the colours of the square's
//           upper left, upper right, lower left and lower right pixel. Width and height are those
//           of the tile, divided by 2^n and rounded up
template <class Pixel>
[[nodiscard]] bool DecodeReducedTile(Transform transform, const CodeHead& head,
                                     std::span<std::string_view> sections, int tile_width,
                                     int tile_height, ImageView<Pixel> pixels);

}  // namespace lf
