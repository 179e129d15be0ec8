// SPDX-License-Identifier: Apache-2.0
// The loop of MosaicCorrector. Internal to this folder.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "lf/collection/prefilter/mosaic_correction.h"

namespace lf {

// Corrects the values of a row, lane by lane.
//   sums   three rows of sums, each beginning at pixel 0: of the row itself, of the rows before and
//          behind it, and of the next ones; two pixels more are read on each side
//   count  number of values; up to 15 more are read and written
void CorrectLanes(const LaneWeights& weights, const std::array<const int32_t*, 3>& sums,
                  size_t count, uint16_t* out);

// Writes the sums of five rows, from the second before to the second behind a row, to the three
// rows of `sums`. Up to 15 values more than `count` are read and written.
void AddRows(const std::array<const uint16_t*, 5>& rows, size_t count,
             const std::array<int32_t*, 3>& sums);

}  // namespace lf
