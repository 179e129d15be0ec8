// SPDX-License-Identifier: Apache-2.0
// Encodes and decodes one tile of an image in the thesis's profile (thesis 4.2.2, 5.4). Internal to
// this folder.
//
// The pixels of a mosaic are sorted into four planes, by their position in each 2 x 2 square
// (Figure 4.6). Other images have one plane for each channel. Tile sizes are powers of two, so that
// the Haar transform of a tile is a part of the transform of the whole image.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lf/pixels/codec/code_head.h"
#include "lf/pixels/codec/wavelet53.h"

namespace lf {

// Thresholded coefficients of a tile. streams[r] holds resolution r of one plane after the other.
// Resolution 0 is the approximation, the others are details from the coarsest level to the finest.
struct HaarTile {
  std::vector<std::vector<int32_t>> streams;
  int32_t low = std::numeric_limits<int32_t>::max();   // least coefficient of all streams
  int32_t high = std::numeric_limits<int32_t>::min();  // largest coefficient of all streams
};

// Transforms a tile, and sets detail coefficients whose magnitude is below the threshold to 0.
//   threshold  CodecSettings::threshold
template <class Pixel>
HaarTile TransformTile(const CodeHead& head, double threshold, ImageView<const Pixel> pixels);

// Returns the encoded coefficients of one resolution of a tile. head.low and head.high must be the
// range of the coefficients of all tiles.
std::string CodeOfSection(const CodeHead& head, const HaarTile& tile, int resolution);

// Decodes the pixels of a tile from its sections, which are ordered by resolution. Returns false if
// a section is damaged.
template <class Pixel>
[[nodiscard]] bool DecodeHaarTile(Transform transform, const CodeHead& head,
                                  std::span<std::string_view> sections, ImageView<Pixel> pixels);

}  // namespace lf
