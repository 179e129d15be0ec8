// SPDX-License-Identifier: Apache-2.0
#include "lf/render/collect/opacity_and_trust.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "lf/core/check.h"

namespace lf {
namespace {

constexpr double kRange = LfPixels::kOpaque - LfPixels::kTransparent;

// Values of opacities by trust, rounded to nearest.
std::array<uint16_t, LfPixels::kTrusted + 1> TrustValues() {
  std::array<uint16_t, LfPixels::kTrusted + 1> values;
  for (uint32_t trust = 0; trust < values.size(); ++trust)
    values[trust] = static_cast<uint16_t>(
        LfPixels::kTransparent + std::lround(kRange * ShownTrust(static_cast<uint8_t>(trust))));
  return values;
}

}  // namespace

double ShownTrust(uint8_t trust) {
  constexpr double kWrongGuesses = 0.75;  // share of pixels without any trust that are wrong
  const double lacking = 1 - static_cast<double>(trust) / LfPixels::kTrusted;
  return 1 - kWrongGuesses * lacking * lacking * lacking;
}

LfPixels TakeOpacityAndTrust(LfPixels* pixels) {
  LF_CHECK(pixels->bayer == BayerPattern::kNone);
  static const auto values = TrustValues();
  const Image<uint16_t>& radiance = pixels->radiance;
  const Image<uint8_t>& trust = pixels->trust;
  const int width = radiance.width();
  LF_CHECK(trust.empty() || (trust.width() == width && trust.height() == radiance.height()));
  const bool has_opacity = !pixels->opacity.empty();
  LfPixels both;
  both.radiance = std::exchange(pixels->opacity, {});
  both.radiance.Resize(width, radiance.height(), LfPixels::kRgbLanes);
  both.any_masked = pixels->any_masked;
  both.rect = pixels->rect;
  for (int y = 0; y < radiance.height(); ++y) {
    const uint16_t* light = radiance.row(y);
    const uint8_t* trusts = trust.empty() ? nullptr : trust.row(y);
    uint16_t* lanes = both.radiance.row(y);
    for (int x = 0; x < width; ++x, light += LfPixels::kRgbLanes, lanes += LfPixels::kRgbLanes) {
      if (light[LfPixels::kRayLane] == 0) {
        std::fill_n(lanes, LfPixels::kRgbLanes, uint16_t{0});
        continue;
      }
      if (!has_opacity) lanes[0] = LfPixels::kOpaque;
      lanes[1] = lanes[2] = trusts == nullptr ? LfPixels::kOpaque : values[trusts[x]];
      lanes[LfPixels::kRayLane] = light[LfPixels::kRayLane];
    }
  }
  return both;
}

}  // namespace lf
