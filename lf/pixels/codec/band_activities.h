// SPDX-License-Identifier: Apache-2.0
// The activities of a band while it is encoded, or decoded by the reference, and the levels that
// they give (band_contexts.h). Internal to this folder.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "lf/pixels/codec/coefficient_coder.h"

namespace lf {

template <class T>
class BandActivities {
 public:
  BandActivities(const CoefficientBand<T>& band, const Strips& strips, int quiet)
      : band_(band),
        columns_(strips.columns),
        quiet_(quiet),
        weights_(WeightsOf(band.kind)),
        here_(band.width + 2),
        above_(band.width + 2),
        above_two_(band.width + 2),
        parents_(band.width),
        sums_(band.width),
        levels_(kMostSum + 1) {
    for (int sum = 0; sum <= kMostSum; ++sum) levels_[sum] = static_cast<uint8_t>(LevelOf(sum));
  }

  // Must be called for each row from y = 0 on, before the functions below are called for it.
  void BeginRow(int y) {
    std::swap(above_two_, above_);
    std::swap(above_, here_);
    if (y % 2 == 0 && band_.parent_width > 0 && band_.parent_height > 0) SetParents(y);
    // Activities of places outside of the band are 0.
    const uint8_t* const above = above_.data() + 1;
    const uint8_t* const above_two = above_two_.data() + 1;
    for (int x = 0; x < band_.width; ++x)
      sums_[x] = static_cast<uint8_t>(weights_.above * above[x] + above[x - 1] + above[x + 1] +
                                      weights_.above_two * above_two[x] + parents_[x]);
  }
  // Returns the level of a coefficient whose neighbours are known.
  int Level(int x) const {
    const int left = x % columns_ == 0 ? above_[x + 1] : here_[x];
    return levels_[std::min(sums_[x] + weights_.left * left, kMostSum)];
  }
  void Set(int x, uint32_t magnitude) { here_[x + 1] = Activity(magnitude); }

 private:
  uint8_t Activity(uint32_t magnitude) const {
    return static_cast<uint8_t>(ActivityOf(magnitude, quiet_));
  }
  void SetParents(int y) {
    const auto* const row =
        band_.parent +
        static_cast<size_t>(std::min(y / 2, band_.parent_height - 1)) * band_.parent_width;
    for (int x = 0; x < band_.width; ++x) {
      const auto value = static_cast<int64_t>(row[std::min(x / 2, band_.parent_width - 1)]);
      parents_[x] = Activity(static_cast<uint32_t>(value < 0 ? -value : value));
    }
  }

  const CoefficientBand<T>& band_;
  const int columns_, quiet_;
  const NeighbourWeights weights_;
  // Activities of three rows, each with a place before and behind.
  std::vector<uint8_t> here_, above_, above_two_;
  std::vector<uint8_t> parents_;  // of the row
  std::vector<uint8_t> sums_;     // of the row, without left neighbours
  std::vector<uint8_t> levels_;   // of sums
};

}  // namespace lf
