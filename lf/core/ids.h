// SPDX-License-Identifier: Apache-2.0
// Integer identities, and the numbers of the frames of a film. Each kind of identity has its own
// type, so that the compiler rejects an id of another kind.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "lf/core/check.h"

namespace lf {

template <class Tag>
struct Id {
  uint32_t value = 0;
  friend auto operator<=>(const Id&, const Id&) = default;
};

// One photograph of the light field: its index in LightField::cameras.
using LfImageId = Id<struct LfImageTag>;

// One rendered image of the sequence, by its number.
using FrameId = Id<struct FrameTag>;

// The largest number of a frame: file names then have at most eight digits.
inline constexpr uint32_t kLargestFrameNumber = 99'999'999;

// The numbers of the frames of a film. They are consecutive, and begin at 1 unless the path states
// another first number, such as 1001, so that frames have the numbers of a shot.
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

template <class Tag>
struct std::hash<lf::Id<Tag>> {
  size_t operator()(lf::Id<Tag> id) const noexcept { return id.value; }
};
