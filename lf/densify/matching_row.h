// SPDX-License-Identifier: Apache-2.0
// The inner loops of ComputeMatchingCosts(), for one row of pixels. Internal to this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "lf/densify/pair_map.h"

namespace lf {

// Pixels of tones [height][width][4] with 16 bits each.
struct TonesView {
  const uint16_t* data = nullptr;
  int width = 0;
  int height = 0;
};

// Compares pixels x_begin ... x_begin + count - 1 of row y of the reference image with a view, at
// inverse depth z. costs[i] is MatchingCosts::kPerTone times the sum of the absolute differences of
// R, G, B and opacity, at most MatchingCosts::kMost; 7/12 of this if the view does not show the
// pixel.
//   reference  ComparedTones() of the first pixel
//   view       ComparedTones()
void CompareRow(const uint16_t* reference, int x_begin, int y, int count, const PairMap& map,
                float z, const TonesView& view, uint16_t* costs);

// Writes the means of 3 x 3 costs: above, middle and below are rows of count + 2 costs, which begin
// a pixel before the first result.
void MeanOfNine(const uint16_t* above, const uint16_t* middle, const uint16_t* below, int count,
                uint16_t* means);

// Writes the least of the means over groups of rows.
//   rows    a row of `count` means for each view
//   groups  the numbers of the views in each group
void LeastOfGroups(const uint16_t* const* rows, std::span<const std::span<const int>> groups,
                   int count, uint8_t* least);

}  // namespace lf
