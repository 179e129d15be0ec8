// SPDX-License-Identifier: Apache-2.0
// The constants of demosaic.h, and what both implementations share. Internal to this folder.
#pragma once

#include <array>
#include <cstddef>

#include "lf/core/check.h"
#include "lf/light_field/model/radiance.h"

namespace lf {

// Radiance that is added before the square root is taken. It is about the radiance below which
// noise of a sensor no longer grows with the light.
inline constexpr float kRootOffset = 0.01f;
// The smallest gradients of green and of other colours, in roots.
inline constexpr float kLeastGreenGradient = 0.01f, kLeastGradient = 0.02f;
// Detail gains: the value of both sums of a window in which nothing varies, and the largest gain.
inline constexpr float kGainPrior = 1e-3f, kMostDetailGain = 2;
// Weight of the neighbours of step 4 that step 3 interpolated.
inline constexpr float kInterpolatedShare = 0.5f;
// The sums of detail gains are taken over sites up to this far away: 5 x 5 sites.
inline constexpr int kWindowReach = 2;

// Converts 16-bit radiances v to balanced radiances and back:
//   balanced = (v - pedestal) factor[c], v = balanced inverse[c] + pedestal
// for the channels c.
struct BalancedLevels {
  explicit BalancedLevels(const RadianceEncoding& encoding)
      : pedestal(static_cast<float>(encoding.pedestal)) {
    for (size_t c = 0; c < 3; ++c) {
      LF_CHECK(encoding.white_balance[c] > 0);
      factor[c] = static_cast<float>(encoding.white_balance[c] / encoding.Scale());
      inverse[c] = static_cast<float>(encoding.Scale() / encoding.white_balance[c]);
    }
  }

  float pedestal;
  std::array<float, 3> factor{}, inverse{};
};

// Returns `position` mirrored about the outermost pixels into [0, size); `size` is at least 2.
inline int Mirrored(int position, int size) {
  while (position < 0 || position >= size)
    position = position < 0 ? -position : 2 * (size - 1) - position;
  return position;
}

}  // namespace lf
