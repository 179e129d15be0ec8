// Finds the depths around which most of the found depths lie. Internal to focus.
#pragma once

#include <vector>

#include "lf/focus/find_subject.h"
#include "lf/focus/place_depth.h"

namespace lf {

// Returns at most three depths, the best first, each away from the better ones. A found depth
// counts for depths around it by a Gaussian in the logarithm of depth. Its width is the uncertainty
// of the found depth, at least 3 %.
std::vector<SubjectDepth> BestDepths(std::vector<FoundDepth> found);

}  // namespace lf
