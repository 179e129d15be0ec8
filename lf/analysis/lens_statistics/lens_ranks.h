// SPDX-License-Identifier: Apache-2.0
// Statistics of the values of one element as means of ranks. Internal to this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "lf/analysis/lens_statistics/lens_statistics.h"
#include "lf/film/plate/sensor_plate.h"

namespace lf {

// The ranks [begin, end) of the values of an element, in ascending order, whose mean a statistic
// is.
struct ValueRange {
  size_t begin = 0;
  size_t end = 0;
  friend bool operator==(const ValueRange&, const ValueRange&) = default;
};

// Returns the ranks of a statistic of `count` values, at least 1. The range is never empty.
//   trim  LensStatisticOptions::trim; used by kTrimmed only
ValueRange RanksOf(LensStatistic statistic, double trim, size_t count);

// Returns the sum and the number of the values with these ranks. Changes the order of the values.
ElementSum SumOfRanks(std::span<uint16_t> values, const ValueRange& ranks);

// One ray, for an order by luminance.
struct RankedRay {
  uint64_t key = 0;  // luminance, then R and G, so that rays with equal keys have equal colours
  uint16_t blue = 0;
  uint16_t opacity = 0;

  // The luminance is 0.2126 R + 0.7152 G + 0.0722 B of the values.
  RankedRay(uint16_t r, uint16_t g, uint16_t b, uint16_t a)
      : key((uint64_t{2126} * r + uint64_t{7152} * g + uint64_t{722} * b) << 32 |
            uint64_t{r} << 16 | g),
        blue(b),
        opacity(a) {}
  uint16_t red() const { return static_cast<uint16_t>(key >> 16); }
  uint16_t green() const { return static_cast<uint16_t>(key); }
  friend auto operator<=>(const RankedRay&, const RankedRay&) = default;
};

// Changes the order of the rays, so that those with these ranks stand at [ranks.begin, ranks.end).
void PutRanksInPlace(std::span<RankedRay> rays, const ValueRange& ranks);

}  // namespace lf
