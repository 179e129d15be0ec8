// SPDX-License-Identifier: Apache-2.0
// How the scale of a coefficient is predicted from its neighbours: the contexts of the entropy
// coder (coefficient_coder.h). Internal to this folder.
//
// The activities of the neighbours of a coefficient, which are their limited magnitudes, are
// multiplied by weights and added. The sum gives one of kLevels levels, and the band states the
// scale of each level (coefficient_scales.h).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "lf/pixels/codec/coefficient_scales.h"

namespace lf {

inline constexpr int kMostActivity = 15;
inline constexpr int kMostQuiet = 20;

// Returns the activity of a coefficient of this magnitude. `quiet` is a property of the band: the
// number of lowest bits that count for nothing, above 0 if most coefficients are large.
inline constexpr int ActivityOf(uint32_t magnitude, int quiet) {
  return static_cast<int>(std::min<uint32_t>(magnitude >> quiet, kMostActivity));
}
// Returns the magnitude from which the activity of a decoded coefficient follows: that of its
// symbol alone, because its plain bits are read later (coefficient_coder.h).
//   shift  ShiftOf() its scale
inline constexpr uint32_t MagnitudeOf(int symbol, int shift) {
  return static_cast<uint32_t>(symbol < 0 ? -symbol : symbol) << shift;
}

// Directions in which the coefficients of a band resemble each other.
enum class BandKind : uint8_t {
  kEven = 0,       // in both directions: an approximation, or high across and down
  kVertical = 1,   // along columns: high across
  kHorizontal = 2  // along rows: high down
};
struct NeighbourWeights {
  int left, above, above_two;
};
// Further weights are 1: of the coefficients above to the left and above to the right, and of the
// parent, the coefficient at the same place of the same band of the next coarser level. A
// coefficient without a left neighbour in its strip takes the one above instead. Neighbours
// outside of the band have no activity.
inline constexpr NeighbourWeights WeightsOf(BandKind kind) {
  return kind == BandKind::kVertical     ? NeighbourWeights{1, 3, 2}
         : kind == BandKind::kHorizontal ? NeighbourWeights{3, 1, 1}
                                         : NeighbourWeights{2, 2, 1};
}

// Sums above kMostSum count as kMostSum.
inline constexpr int kMostSum = 119;
// Level i has the sums from kLevelBegins[i] on. From 16 on, they are multiples of 8.
inline constexpr std::array<int, 18> kLevelBegins = {0,  1,  2,  3,  4,  5,  6,  8,  10,
                                                     13, 16, 24, 32, 40, 56, 72, 88, 104};
inline constexpr int kLevels = static_cast<int>(kLevelBegins.size());
// Returns the level of a sum of weighted activities.
inline int LevelOf(int sum) {
  static constexpr auto kLevelOfSum = [] {
    std::array<uint8_t, kMostSum + 1> levels{};
    for (int i = 0, level = 0; i <= kMostSum; ++i) {
      if (level + 1 < kLevels && i >= kLevelBegins[level + 1]) ++level;
      levels[i] = static_cast<uint8_t>(level);
    }
    return levels;
  }();
  return kLevelOfSum[std::min(sum, kMostSum)];
}
// Scales that the levels usually have. A band states the differences to these.
inline constexpr std::array<int, kLevels> kUsualScales = {8,  11, 13, 14, 15, 16, 17, 19, 21,
                                                          22, 24, 26, 28, 29, 31, 33, 35, 38};
// Scale of the distribution by which these differences are coded.
inline constexpr int kScaleOfDifferences = 16;

// A band is divided into strips, which are decoded at the same time, each by a coder of its own:
// strip i has the columns from i * columns on. The last strips may be narrower, or empty.
struct Strips {
  int count = 1;
  int columns = 0;  // of the first strip
};
inline constexpr int kMostStrips = 32;
// Returns the number of strips of bands of at most this width: kMostStrips, 8 or 1.
inline constexpr int StripCount(int width) {
  return width >= 64 ? kMostStrips : width >= 16 ? 8 : 1;
}
inline constexpr Strips StripsOf(int strip_count, int width) {
  return {strip_count, (width + strip_count - 1) / strip_count};
}
// Returns the strip whose coefficient is decoded in turn `turn` of each column. With kMostStrips,
// these are 0, 4, ..., 28, 1, 5, ..., 29, 2, ...: vectors then need few instructions to sort the
// symbols of four coders into bytes.
inline constexpr int StripInTurn(int turn, int strip_count) {
  return strip_count == kMostStrips ? turn % 8 * 4 + turn / 8 : turn;
}

// The states of the coder are at least kLeastState between two coefficients, and below
// kLeastState * 2^16.
inline constexpr uint32_t kLeastState = 1U << 15;

}  // namespace lf
