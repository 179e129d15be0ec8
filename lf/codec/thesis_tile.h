// One tile by the thesis's profile (thesis 4.2.2, 5.4). Internal to codec.
//
// The pixels of a mosaic go into four planes, by their place among two by two (Figure 4.6); those
// of other images into a plane for each channel. Tiles are as large as a power of two, so that the
// Haar transform of each is a part of that of the whole image.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lf/codec/code_head.h"
#include "lf/codec/wavelet53.h"

namespace lf {

// Coefficients of a tile, thresholded: by resolution, 0 the approximation; plane after plane.
struct HaarTile {
  std::vector<std::vector<int32_t>> streams;
  int32_t low = std::numeric_limits<int32_t>::max();  // of all of them
  int32_t high = std::numeric_limits<int32_t>::min();
};

// threshold  as in CodecSettings
template <class Pixel>
HaarTile TransformTile(const CodeHead& head, double threshold, ImageView<const Pixel> pixels);

// The code of one resolution of a tile; head.low and head.high are of all tiles.
std::string CodeOfSection(const CodeHead& head, const HaarTile& tile, int resolution);

// The pixels of a tile from its sections, by resolution. False: damage.
template <class Pixel>
[[nodiscard]] bool DecodeHaarTile(Transform transform, const CodeHead& head,
                                  std::span<std::string_view> sections, ImageView<Pixel> pixels);

}  // namespace lf
