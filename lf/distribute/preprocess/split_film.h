// Cuts a film into sections, one for each package.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lf {

// Range [begin, end) of the given frames.
struct Section {
  size_t begin = 0;
  size_t end = 0;

  size_t size() const { return end - begin; }
  friend bool operator==(const Section&, const Section&) = default;
};

// Returns `count` sections of about equal cost, in order; fewer if there are fewer frames. Sections
// are contiguous, because neighbouring frames share LF images.
std::vector<Section> SplitByCost(std::span<const uint64_t> costs, size_t count);

// Returns the smallest number of sections of about equal cost such that each has at most
// most_frames frames.
std::vector<Section> SplitToFit(std::span<const uint64_t> costs, size_t most_frames);

}  // namespace lf
