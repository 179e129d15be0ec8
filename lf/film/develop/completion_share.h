// SPDX-License-Identifier: Apache-2.0
// How a completion counts in an element (develop.h). Internal to this folder.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

#include "lf/film/develop/develop.h"

namespace lf {

// Returns the weight of the completion in a channel of element (x, y) that has `count` collected
// rays: Completion::share, but 1 if `count` is 0 and the share is not; 0 without completion.
inline double CompletionShareOf(const Completion* completion, int x, int y, uint64_t count) {
  if (completion == nullptr) return 0;
  const double share = completion->share.at(x, y);
  return count == 0 && share > 0 ? 1 : share;
}

// Returns the number of rays that decides whether a channel is filled: `count`, or the largest
// uint32_t if the completion has a share in the element, which then needs no fill.
inline uint32_t KnownCount(const Completion* completion, int x, int y, uint64_t count) {
  constexpr uint64_t kMostCount = std::numeric_limits<uint32_t>::max();
  const bool is_completed = completion != nullptr && completion->share.at(x, y) > 0;
  return static_cast<uint32_t>(is_completed ? kMostCount : std::min(count, kMostCount));
}

}  // namespace lf
