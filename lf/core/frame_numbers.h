// SPDX-License-Identifier: Apache-2.0
// The numbers of the frames of a film. They are consecutive, and begin at 1 unless the path states
// another first number, such as 1001, so that frames have the numbers of a shot.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "lf/core/check.h"
#include "lf/core/ids.h"
#include "lf/core/parse_number.h"

namespace lf {

// The largest number of a frame: file names then have at most eight digits.
inline constexpr uint32_t kLargestFrameNumber = 99'999'999;

// Returns the number if the whole of `text` is one that a frame may have, otherwise nullopt.
inline std::optional<uint32_t> ParseFrameNumber(std::string_view text) {
  const std::optional<uint32_t> number = ParseWhole<uint32_t>(text);
  return number && *number <= kLargestFrameNumber ? number : std::nullopt;
}

struct FrameNumbers {
  uint32_t first = 1;  // number of the first frame, which is at time 0
  size_t count = 0;    // number of frames; last() is at most kLargestFrameNumber

  // Number of the last frame. There must be a frame.
  uint32_t last() const { return first + static_cast<uint32_t>(count) - 1; }
  bool Has(FrameId frame) const { return frame.value >= first && frame.value - first < count; }
  // Returns the frame with an index, which counts from 0.
  FrameId At(size_t index) const {
    LF_CHECK(index < count);
    return {first + static_cast<uint32_t>(index)};
  }
  // Returns the index of a frame, from 0 to count - 1.
  size_t IndexOf(FrameId frame) const {
    LF_CHECK(Has(frame));
    return frame.value - first;
  }
  // Returns all frames, in ascending order.
  std::vector<FrameId> All() const {
    std::vector<FrameId> frames(count);
    for (size_t i = 0; i < count; ++i) frames[i] = At(i);
    return frames;
  }
  friend bool operator==(const FrameNumbers&, const FrameNumbers&) = default;
};

}  // namespace lf
