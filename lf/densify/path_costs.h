// SPDX-License-Identifier: Apache-2.0
// The inner loop of semi-global matching. Internal to this folder.
#pragma once

#include <cstdint>

namespace lf {

// Extends a path by a pixel: for each plane j
//   next[j] = cost[j] - least
//             + min(last[j], last[j - 1] + small, last[j + 1] + small, least + large)
// and adds next[j] to sums[j]. Returns the least of next.
//   last   path costs of the pixel before; last[-1] and last[stride] are readable and large
//   least  the least of `last`
uint16_t ExtendPath(const uint8_t* cost, const uint16_t* last, uint16_t least, uint16_t small,
                    uint16_t large, int stride, uint16_t* next, uint16_t* sums);

}  // namespace lf
