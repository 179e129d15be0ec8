// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/trust.h"

#include <algorithm>
#include <cmath>

namespace lf {

float SpreadOf(std::span<const WeighedColour> colours) {
  constexpr float kFloor = 0.02f * 3 * 65535;
  std::array<float, LfPixels::kRayLane> mean = {};
  float weights = 0;
  for (const WeighedColour& one : colours) {
    for (size_t c = 0; c < mean.size(); ++c) mean[c] += one.weight * one.colour[c];
    weights += one.weight;
  }
  if (!(weights > 0)) return 0;
  float light = kFloor;
  for (float& value : mean) light += std::max(0.0f, value /= weights);
  float deviations = 0;
  for (const WeighedColour& one : colours)
    for (size_t c = 0; c < mean.size(); ++c)
      deviations += one.weight * std::abs(one.colour[c] - mean[c]);
  return deviations / (weights * light);
}

uint8_t TrustOf(float votes, float spread) {
  const float agreement = std::clamp(1 - spread / kVisibleSpread, 0.0f, 1.0f);
  return static_cast<uint8_t>(std::clamp(votes, 0.0f, 1.0f) * agreement * LfPixels::kTrusted +
                              0.5f);
}

}  // namespace lf
