// SPDX-License-Identifier: Apache-2.0
// The median of values.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "lf/core/check.h"

namespace lf {

// Returns the median of at least one value; the larger of the two middle values if their number is
// even.
template <class T>
T Median(std::vector<T> values) {
  LF_CHECK(!values.empty());
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace lf
