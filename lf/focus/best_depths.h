// SPDX-License-Identifier: Apache-2.0
// Finds the depths around which most of the depths found in an LF image lie. Internal to focus.
#pragma once

#include <vector>

#include "lf/focus/find_subject.h"
#include "lf/focus/place_depth.h"

namespace lf {

// Returns at most three depths, the best first; each is clearly different from the better ones.
// Each depth in `found` supports the depths around it by its weight times a Gaussian in the
// logarithm of depth, whose standard deviation is FoundDepth::error, but at least 3 %.
std::vector<SubjectDepth> BestDepths(std::vector<FoundDepth> found);

}  // namespace lf
