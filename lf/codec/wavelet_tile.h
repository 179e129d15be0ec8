// One tile by the wavelets of the default and the lossless profile. Internal to codec.
//
// A mosaic is transformed once as it is: this separates brightness and colours better than planes
// of equal colour do. The four bands are its components, and are transformed on; so are the one
// plane of a grey image and the three of a coloured one (rgb_planes.h).
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lf/codec/code_head.h"
#include "lf/codec/wavelet53.h"

namespace lf {

// Sets what of the head belongs to the profile: fractions and steps.
void SetSteps(const CodecSettings& settings, CodeHead* head);

// The coefficients of a tile, quantised: streams by component and resolution, 0 the approximation,
// then details from the coarsest level to the finest.
struct QuantizedTile {
  std::vector<std::vector<int32_t>> streams;  // [component][resolution]
  int32_t largest = 0;                        // of all coefficients, before they were quantised
};

template <class Pixel>
QuantizedTile QuantizeTile(Transform transform, const CodeHead& head,
                           ImageView<const Pixel> pixels);

// Whether coefficients of two bytes are enough: sums of two on the way stay within.
bool FitsInTwoBytes(int32_t largest);

// The code of one resolution of a tile.
std::string CodeOfSection(const CodeHead& head, const QuantizedTile& tile, int resolution);

// The pixels of a tile from its sections, by resolution. False: damage.
template <class Pixel>
[[nodiscard]] bool DecodeWaveletTile(Transform transform, const CodeHead& head,
                                     std::span<std::string_view> sections, ImageView<Pixel> pixels);

}  // namespace lf
