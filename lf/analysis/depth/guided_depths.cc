// SPDX-License-Identifier: Apache-2.0
#include "lf/analysis/depth/guided_depths.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <utility>
#include <vector>

#include "lf/analysis/depth/lens_views.h"
#include "lf/analysis/depth/plane_sweep.h"

namespace lf {
namespace {

// Difference of colours, as a share of white and a mean over R, G and B, at which a fellow counts
// 1 / e of an element of equal colour. Elements at borders mix two colours, so that it is wide.
constexpr double kSimilar = 0.25;
// Only depths with at least this confidence are tested, and confirm others.
constexpr float kSure = 0.5f;
constexpr size_t kSteps = 256;  // entries of the table of weights, which spans 4 kSimilar
constexpr double kFullWeight = 1024;

constexpr std::pair<int, int> kDirections[] = {{1, 0}, {-1, 0}, {0, 1},  {0, -1},
                                               {1, 1}, {1, -1}, {-1, 1}, {-1, -1}};

// A fellow with a depth.
struct Fellow {
  float index;
  float confidence;
  uint32_t weight;
};

// Sums of weights.
struct Support {
  uint64_t all = 0;
  uint64_t equal = 0;     // number of fellows whose depth is equal to a given one
  double confidence = 0;  // sum of weight * confidence over these

  bool IsMajority() const { return 20 * equal >= 11 * all; }
};

class Guide {
 public:
  //   least_confidence  elements with this confidence, and more than 0, have a depth
  Guide(const GuideOptions& options, float least_confidence, const SweptMap& map)
      : options_(options), least_confidence_(least_confidence), map_(map) {
    for (size_t i = 0; i < kSteps; ++i) {
      const double sigmas = 4 * static_cast<double>(i) / kSteps;
      weights_[i] = static_cast<uint32_t>(std::lround(kFullWeight * std::exp(-sigmas * sigmas)));
    }
    steps_per_root_ = kSteps / (4 * kSimilar * 3 * options.white_root);
  }

  bool IsKnown(int x, int y) const {
    const float confidence = map_.confidence.at(x, y);
    return confidence >= least_confidence_ && confidence > 0;
  }
  bool AreEqual(float a, float b) const { return std::abs(a - b) <= options_.same_depth; }

  // Returns the sum of the weights of all fellows of an element, itself included, and those that
  // have a depth.
  uint64_t FellowsOf(int x, int y, std::vector<Fellow>* known) const {
    known->clear();
    uint64_t all = 0;
    const int left = std::max(0, x - options_.radius);
    const int right = std::min(map_.index.width(), x + options_.radius + 1);
    const int bottom = std::min(map_.index.height(), y + options_.radius + 1);
    const uint16_t* const own = &map_.roots.at(x, y);
    for (int row = std::max(0, y - options_.radius); row < bottom; ++row)
      for (int column = left; column < right; ++column) {
        const uint16_t* const other = &map_.roots.at(column, row);
        int difference = 0;
        for (int c = 0; c < 3; ++c) difference += std::abs(int{own[c]} - int{other[c]});
        const auto step = static_cast<size_t>(difference * steps_per_root_);
        if (step >= kSteps) continue;
        all += weights_[step];
        if (!IsKnown(column, row)) continue;
        known->push_back(
            {map_.index.at(column, row), map_.confidence.at(column, row), weights_[step]});
      }
    return all;
  }

  Support SupportOf(float index, uint64_t all, const std::vector<Fellow>& known) const {
    Support support{all};
    for (const Fellow& fellow : known) {
      if (!AreEqual(fellow.index, index)) continue;
      support.equal += fellow.weight;
      support.confidence += double{fellow.confidence} * fellow.weight;
    }
    return support;
  }

 private:
  const GuideOptions& options_;
  const float least_confidence_;
  const SweptMap& map_;
  std::array<uint32_t, kSteps> weights_;
  double steps_per_root_;
};

// Returns the least index with half of the weight at or below it. Sorts the fellows.
float WeightedMedian(std::vector<Fellow>* known) {
  std::sort(known->begin(), known->end(),
            [](const Fellow& a, const Fellow& b) { return a.index < b.index; });
  uint64_t sum = 0;
  for (const Fellow& fellow : *known) sum += fellow.weight;
  uint64_t below = 0;
  for (const Fellow& fellow : *known) {
    below += fellow.weight;
    if (2 * below >= sum) return fellow.index;
  }
  return known->back().index;
}

// Calls body(x, y, &fellows) for all elements. `fellows` is memory that calls of a row share.
template <class Body>
void ForEachElement(const SweptMap& map, ThreadPool& pool, const Body& body) {
  pool.ForEach(static_cast<size_t>(map.index.height()), [&](size_t row) {
    std::vector<Fellow> fellows;
    for (int x = 0; x < map.index.width(); ++x) body(x, static_cast<int>(row), &fellows);
  });
}

// The first step of DoubtLonelyDepths(): elements whose fellows have another depth, or none.
void DoubtMinorities(const GuideOptions& options, ThreadPool& pool, SweptMap* map) {
  const Guide guide(options, kSure, *map);
  Image<float> confidence = map->confidence;
  ForEachElement(*map, pool, [&](int x, int y, std::vector<Fellow>* known) {
    if (!guide.IsKnown(x, y)) return;
    const uint64_t all = guide.FellowsOf(x, y, known);
    const Support support = guide.SupportOf(map->index.at(x, y), all, *known);
    if (!support.IsMajority()) confidence.at(x, y) *= kDoubtful;
  });
  map->confidence = std::move(confidence);
}

// Returns the difference of the light of two elements.
int DifferenceOf(const SweptMap& map, int x, int y, int other_x, int other_y) {
  int difference = 0;
  for (int c = 0; c < 3; ++c)
    difference += std::abs(int{LightOfRoot(map.roots.at(x, y, c))} -
                           int{LightOfRoot(map.roots.at(other_x, other_y, c))});
  return difference;
}

// The second step: elements between a surface and a place without depth whose light is more that of
// the place. They are mixtures of both, so that they have few fellows but each other.
void DoubtMixtures(const GuideOptions& options, ThreadPool& pool, SweptMap* map) {
  constexpr int kAway = 2;  // elements on either side that are no mixtures
  // Smaller differences are no border: a quarter of white in each of R, G and B.
  const int least_difference = 3 * LightOfRoot(static_cast<uint16_t>(options.white_root)) / 4;
  const Guide guide(options, kSure, *map);
  const int width = map->index.width(), height = map->index.height();
  Image<float> confidence = map->confidence;
  const auto is_mixture = [&](int x, int y, int dx, int dy) {
    const int out_x = x + kAway * dx, out_y = y + kAway * dy;
    const int in_x = x - kAway * dx, in_y = y - kAway * dy;
    if (std::min({out_x, out_y, in_x, in_y}) < 0 || std::max(out_x, in_x) >= width ||
        std::max(out_y, in_y) >= height)
      return false;
    return !guide.IsKnown(x + dx, y + dy) && !guide.IsKnown(out_x, out_y) &&
           guide.IsKnown(in_x, in_y) &&
           DifferenceOf(*map, in_x, in_y, out_x, out_y) > least_difference &&
           DifferenceOf(*map, x, y, out_x, out_y) < DifferenceOf(*map, x, y, in_x, in_y);
  };
  ForEachElement(*map, pool, [&](int x, int y, std::vector<Fellow>*) {
    if (!guide.IsKnown(x, y)) return;
    for (const auto& [dx, dy] : kDirections)
      if (is_mixture(x, y, dx, dy)) {
        confidence.at(x, y) *= kDoubtful;
        return;
      }
  });
  map->confidence = std::move(confidence);
}

}  // namespace

void DoubtLonelyDepths(const GuideOptions& options, ThreadPool& pool, SweptMap* map) {
  DoubtMinorities(options, pool, map);
  DoubtMixtures(options, pool, map);
}

void MendDepths(const GuideOptions& options, ThreadPool& pool, SweptMap* map) {
  const Guide guide(options, options.least_confidence, *map);
  Image<float> index = map->index, confidence = map->confidence;
  ForEachElement(*map, pool, [&](int x, int y, std::vector<Fellow>* known) {
    const uint64_t all = guide.FellowsOf(x, y, known);
    if (known->empty()) return;
    const float median = WeightedMedian(known);
    if (guide.IsKnown(x, y) && guide.AreEqual(map->index.at(x, y), median)) return;
    const Support support = guide.SupportOf(median, all, *known);
    if (!support.IsMajority()) return;
    index.at(x, y) = median;
    confidence.at(x, y) =
        static_cast<float>(support.confidence / static_cast<double>(support.equal));
  });
  map->index = std::move(index);
  map->confidence = std::move(confidence);
}

}  // namespace lf
