// SPDX-License-Identifier: Apache-2.0
// The weights of Catmull and Rom's cubic interpolation (Keys 1981, a = -1/2).
#pragma once

#include <array>

namespace lf {

// Returns the weights of the values at -1, 0, 1 and 2 for a position t in [0, 1] behind value 0.
// Their sum is 1; with t = 0 they are exactly 0, 1, 0 and 0.
template <class T>
std::array<T, 4> CatmullRomWeights(T t) {
  const T t2 = t * t, t3 = t2 * t, half = T(0.5);
  return {-half * t3 + t2 - half * t, T(1.5) * t3 - T(2.5) * t2 + 1,
          -T(1.5) * t3 + 2 * t2 + half * t, half * t3 - half * t2};
}

}  // namespace lf
