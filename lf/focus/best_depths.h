// The depths around which most of what was found lies. Internal to focus.
#pragma once

#include <vector>

#include "lf/focus/find_subject.h"
#include "lf/focus/place_depth.h"

namespace lf {

// Returns at most three depths, the best first, each away from the better ones. A found depth
// counts around itself by a bell in the logarithm of depth, which is as wide as the depth is
// uncertain, and 3 % at least.
std::vector<SubjectDepth> BestDepths(std::vector<FoundDepth> found);

}  // namespace lf
