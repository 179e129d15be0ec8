// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/trust.h"

#include <algorithm>
#include <cmath>

namespace lf {

float SpreadOf(std::span<const WeighedColour> colours) {
  constexpr float kFloor = 0.02f * 3 * 65535;
  PixelLanes mean = {};
  float weights = 0;
  for (const WeighedColour& one : colours) {
    mean += one.weight * one.colour;
    weights += one.weight;
  }
  if (!(weights > 0)) return 0;
  mean /= weights;
  const PixelLanes shown = mean > 0 ? mean : 0 * mean;
  const float light = kFloor + shown[0] + shown[1] + shown[2];
  PixelLanes sums = {};
  for (const WeighedColour& one : colours) {
    const PixelLanes difference = one.colour - mean;
    sums += one.weight * (difference > 0 ? difference : -difference);
  }
  const float deviations = sums[0] + sums[1] + sums[2];
  return deviations / (weights * light);
}

uint8_t TrustOf(float votes, float spread) {
  const float agreement = std::clamp(1 - spread / kVisibleSpread, 0.0f, 1.0f);
  return static_cast<uint8_t>(std::clamp(votes, 0.0f, 1.0f) * agreement * LfPixels::kTrusted +
                              0.5f);
}

}  // namespace lf
