// SPDX-License-Identifier: Apache-2.0
// The values of all rays of some elements of a frame, and their statistics. Internal to this
// folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lf/analysis/lens_statistics/lens_ranks.h"
#include "lf/analysis/lens_statistics/lens_statistics.h"
#include "lf/core/geometry.h"
#include "lf/core/large_vector.h"
#include "lf/film/plate/sensor_plate.h"

namespace lf {

// The values of the elements of some rows of the plate.
class ElementValues {
 public:
  //   most  largest number of values of an element
  ElementValues(int width, const PixelRect& part, int channels, size_t most)
      : width_(width),
        part_(part),
        channels_(static_cast<size_t>(channels)),
        most_(most),
        counts_(static_cast<size_t>(part.pixel_count())),
        values_(counts_.size() * channels_ * most) {}

  static size_t BytesOfRow(int width, int channels, size_t most) {
    return static_cast<size_t>(width) *
           (sizeof(uint32_t) + static_cast<size_t>(channels) * most * sizeof(uint16_t));
  }

  const PixelRect& part() const { return part_; }

  // Adds the rays of one LF image, row by row of the part.
  void AddRow(const SensorPlate& plate, int y);

  uint32_t Count(int x, int y) const { return counts_[IndexOf(x, y)]; }

  // Adds the values with the ranks of the statistic to the elements of a row of the plate.
  void TakeRow(int y, const LensStatisticOptions& options, SensorPlate* plate);

 private:
  size_t IndexOf(int x, int y) const {
    return static_cast<size_t>(y - part_.y_begin) * static_cast<size_t>(width_) +
           static_cast<size_t>(x);
  }
  uint16_t* Of(int x, int y, size_t channel) {
    return values_.data() + (IndexOf(x, y) * channels_ + channel) * most_;
  }
  // Returns the values of a channel of an element, in the order in which LF images were added.
  std::span<uint16_t> Values(int x, int y, size_t channel) {
    return {Of(x, y, channel), Count(x, y)};
  }
  void TakeByLuminance(int x, int y, const ValueRange& ranks, std::vector<RankedRay>* rays,
                       SensorPlate* plate);

  int width_;
  PixelRect part_;
  size_t channels_, most_;
  LargeVector<uint32_t> counts_;
  LargeVector<uint16_t> values_;  // [element][channel][most_]
};

}  // namespace lf
