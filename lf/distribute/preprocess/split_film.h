// SPDX-License-Identifier: Apache-2.0
// Divides a film into sections, one for each package.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lf {

// Range [begin, end) of indices in the list of frames that are divided.
struct Section {
  size_t begin = 0;
  size_t end = 0;

  size_t size() const { return end - begin; }
  friend bool operator==(const Section&, const Section&) = default;
};

// Divides frames into `count` sections of about equal cost; if there are fewer frames than `count`,
// each frame is a section. Sections are contiguous, because neighbouring frames share LF images.
//   costs  the cost of each frame, in any unit
std::vector<Section> SplitByCost(std::span<const uint64_t> costs, size_t count);

// Divides frames into sections of about equal cost: into the fewest sections such that each has at
// most most_frames frames.
std::vector<Section> SplitToFit(std::span<const uint64_t> costs, size_t most_frames);

}  // namespace lf
