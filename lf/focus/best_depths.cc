// SPDX-License-Identifier: Apache-2.0
#include "lf/focus/best_depths.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace lf {
namespace {

// A found depth supports the depths around it by a Gaussian in the logarithm of depth. WidthOf()
// returns the standard deviation of the Gaussian, ShareAt() its value.
double WidthOf(const FoundDepth& found) { return std::max(0.03, found.error); }
double ShareAt(double distance_w, const FoundDepth& found) {
  const double off = std::log(found.distance_w / distance_w) / WidthOf(found);
  return std::abs(off) < 3 ? std::exp(-0.5 * off * off) : 0;
}

// Returns the found depth with the most support, refined to the weighted mean (of 1 / depth) of the
// found depths near it.
//   total_weight  sum of the weights of all found depths, also of those that `found` no longer has
SubjectDepth BestDepth(std::span<const FoundDepth> found, double total_weight) {
  double best_weight = -1, best_w = 0;
  for (const FoundDepth& at : found) {
    double weight = 0;
    for (const FoundDepth& other : found) weight += other.weight * ShareAt(at.distance_w, other);
    if (weight > best_weight) {
      best_weight = weight;
      best_w = at.distance_w;
    }
  }
  SubjectDepth depth;
  double sum = 0, weights = 0;
  for (const FoundDepth& one : found) {
    const double share = ShareAt(best_w, one);
    sum += one.weight * share / one.distance_w;
    weights += one.weight * share;
    depth.place_count += share > 0.3;
  }
  depth.distance_w = weights / sum;
  depth.share = weights / total_weight;
  return depth;
}

}  // namespace

std::vector<SubjectDepth> BestDepths(std::vector<FoundDepth> found, size_t most) {
  double total_weight = 0;
  for (const FoundDepth& one : found) total_weight += one.weight;
  std::vector<SubjectDepth> depths;
  while (depths.size() < most && !found.empty()) {
    depths.push_back(BestDepth(found, total_weight));
    std::erase_if(found, [&](const FoundDepth& one) {
      return std::abs(std::log(one.distance_w / depths.back().distance_w)) < 3 * WidthOf(one);
    });
  }
  return depths;
}

void PutSubjectFirst(std::vector<SubjectDepth>* depths) {
  constexpr double kBefore = 0.8, kLargeWeight = 0.25;
  auto subject = depths->begin();
  for (auto depth = depths->begin(); depth != depths->end(); ++depth)
    if (depth->distance_w < kBefore * depths->front().distance_w &&
        depth->share >= std::max(kLeastSubjectShare, kLargeWeight * depths->front().share) &&
        depth->place_count >= kLeastSubjectPlaces && depth->distance_w < subject->distance_w)
      subject = depth;
  if (subject != depths->end()) std::rotate(depths->begin(), subject, subject + 1);
}

}  // namespace lf
