// SPDX-License-Identifier: Apache-2.0
// Finds the depths around which most of the depths found in an LF image lie. Internal to focus.
#pragma once

#include <cstddef>
#include <vector>

#include "lf/focus/find_subject.h"
#include "lf/focus/place_depth.h"

namespace lf {

// Returns at most `most` depths, the one with the most weight around it first; each is clearly
// different from the better ones. Each depth in `found` supports the depths around it by its weight
// times a Gaussian in the logarithm of depth, whose standard deviation is FoundDepth::error, but at
// least 3 %.
std::vector<SubjectDepth> BestDepths(std::vector<FoundDepth> found, size_t most = 3);

// Least number of places, and least share of the weight, around a depth that is sure.
inline constexpr size_t kLeastSubjectPlaces = 8;
inline constexpr double kLeastSubjectShare = 0.1;

// Moves the depth of the subject to the front, because people photograph what stands before other
// things: the nearest of the depths that are more than a fifth nearer than the first one and have
// at least a quarter of its weight, a tenth of all weight, and eight places.
void PutSubjectFirst(std::vector<SubjectDepth>* depths);

}  // namespace lf
