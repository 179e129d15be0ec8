// SPDX-License-Identifier: Apache-2.0
// How far a pixel of a virtual LF image can be trusted.
#pragma once

#include <cstdint>
#include <span>

#include "lf/densify/pixel_lanes.h"
#include "lf/light_field/model/lf_pixels.h"

namespace lf {

// The colour that a source shows at a pixel, in 16-bit radiance.
struct WeighedColour {
  PixelLanes colour = {};  // the last lane does not count
  float weight = 0;        // at least 0
};

// Returns how far colours lie apart: the weighted mean of |c - m| over all colours c, summed over
// R, G and B, where m is the weighted mean of c, divided by the sum of m. A floor of 2 % of the
// largest radiance is added to the divisor, so that the noise of dark pixels does not count. 0 if
// no colour has a weight above 0.
float SpreadOf(std::span<const WeighedColour> colours);

// Returns the trust in a pixel, from 0 to LfPixels::kTrusted: `votes`, clamped to 0 and 1, times an
// agreement of colours, which falls from 1 to 0 as `spread` grows from 0 to kVisibleSpread.
//   votes   for the depth that the pixel shows (Synthesize()): 1 if all sources have it
//   spread  SpreadOf() of the sources that have this depth
inline constexpr float kVisibleSpread = 0.25f;
uint8_t TrustOf(float votes, float spread);

}  // namespace lf
