// A film cut into sections, one package each.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lf {

// Frames [begin, end) of those given.
struct Section {
  size_t begin = 0;
  size_t end = 0;

  size_t size() const { return end - begin; }
  friend bool operator==(const Section&, const Section&) = default;
};

// `count` sections of about equal cost, in order; fewer if there are fewer frames. Neighbouring
// frames share LF images, so that sections are never taken apart.
std::vector<Section> SplitByCost(std::span<const uint64_t> costs, size_t count);

// As few of about equal cost as have at most most_frames frames each.
std::vector<Section> SplitToFit(std::span<const uint64_t> costs, size_t most_frames);

}  // namespace lf
