// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/semi_global.h"

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "lf/core/large_vector.h"
#include "lf/densify/path_costs.h"

namespace lf {
namespace {

constexpr int kPaths = 8;
// Larger than any path cost: these are at most kCarved + kLargeStep.
constexpr uint16_t kNoPath = 30000;

int Difference(const uint16_t* a, const uint16_t* b) {
  // An object may be as dark as the transparent pixels around it.
  const int of_opacity = a[3] == 0 || b[3] == 0 ? 0 : std::abs(a[3] - b[3]);
  return (std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2])) / 3 + of_opacity;
}

// Returns the cost of a large step between two pixels with these tones.
uint16_t LargeStep(const uint16_t* a, const uint16_t* b) {
  return static_cast<uint16_t>(std::max(kSmallStep + 1, kLargeStep / (1 + Difference(a, b) / 6)));
}

// Path costs of a row of pixels, for one direction of paths.
class PathRow {
 public:
  PathRow(int width, int stride)
      : stride_(static_cast<size_t>(stride) + 2 * kGuard),
        values_(static_cast<size_t>(width) * stride_, kNoPath),
        least_(static_cast<size_t>(width)) {}
  uint16_t* At(int x) { return values_.data() + static_cast<size_t>(x) * stride_ + kGuard; }
  uint16_t& LeastAt(int x) { return least_[static_cast<size_t>(x)]; }

 private:
  static constexpr size_t kGuard = 1;
  size_t stride_;
  LargeVector<uint16_t> values_;
  std::vector<uint16_t> least_;
};

class Matcher {
 public:
  Matcher(const MatchingCosts& costs, const Image<uint16_t>& tones)
      : costs_(costs),
        tones_(tones),
        width_(costs.rect.width()),
        height_(costs.rect.height()),
        sums_(static_cast<size_t>(width_) * height_ * costs.stride) {}

  // Adds the costs of paths that come from above (step 1) or from below (step -1), and of those
  // along the row in the same sense.
  void Sweep(int step, InterruptFlag interrupted) {
    std::vector<PathRow> last(4, PathRow(width_, costs_.stride)), next = last;
    for (int i = 0, y = step > 0 ? 0 : height_ - 1; i < height_ && !IsSet(interrupted);
         ++i, y += step) {
      for (int k = 0, x = step > 0 ? 0 : width_ - 1; k < width_; ++k, x += step) {
        Extend(x, y, step, 0, &next[0], &next[0]);
        Extend(x, y, 0, step, &last[1], &next[1]);
        Extend(x, y, step, step, &last[2], &next[2]);
        Extend(x, y, -step, step, &last[3], &next[3]);
      }
      std::swap(last, next);
    }
  }

  const uint16_t* SumsAt(int x, int y) const {
    return sums_.data() + (static_cast<size_t>(y) * width_ + x) * costs_.stride;
  }

 private:
  const uint16_t* TonesAt(int x, int y) const {
    return &tones_.at(x + costs_.rect.x_begin, y + costs_.rect.y_begin);
  }
  // Extends the path that comes from pixel (x - dx, y - dy). A path begins at the border of the
  // rectangle.
  void Extend(int x, int y, int dx, int dy, PathRow* from, PathRow* to) {
    const int from_x = x - dx, from_y = y - dy;
    const uint8_t* cost = costs_.At(x, y);
    uint16_t* next = to->At(x);
    uint16_t* sums = sums_.data() + (static_cast<size_t>(y) * width_ + x) * costs_.stride;
    if (from_x < 0 || from_x >= width_ || from_y < 0 || from_y >= height_) {
      uint16_t least = kNoPath;
      for (int j = 0; j < costs_.stride; ++j) {
        next[j] = cost[j];
        sums[j] = static_cast<uint16_t>(sums[j] + cost[j]);
        least = std::min<uint16_t>(least, cost[j]);
      }
      to->LeastAt(x) = least;
      return;
    }
    to->LeastAt(x) =
        ExtendPath(cost, from->At(from_x), from->LeastAt(from_x), kSmallStep,
                   LargeStep(TonesAt(x, y), TonesAt(from_x, from_y)), costs_.stride, next, sums);
  }

  const MatchingCosts& costs_;
  const Image<uint16_t>& tones_;
  const int width_, height_;
  LargeVector<uint16_t> sums_;  // [height][width][stride]
};

// Returns the place of the least sum, by a parabola through it and the sums beside it.
float PlaceOf(const uint16_t* sums, int best, int planes) {
  if (best == 0 || best + 1 == planes) return static_cast<float>(best);
  const int before = sums[best - 1], here = sums[best], behind = sums[best + 1];
  const int curvature = before - 2 * here + behind;
  if (curvature <= 0) return static_cast<float>(best);
  return static_cast<float>(best) +
         0.5f * static_cast<float>(before - behind) / static_cast<float>(curvature);
}

uint16_t LeadOf(const uint16_t* sums, int best, int planes) {
  constexpr int kBeside = 2;
  int other = 65535;
  for (int j = 0; j < planes; ++j)
    if (std::abs(j - best) > kBeside) other = std::min<int>(other, sums[j]);
  return static_cast<uint16_t>(std::max(0, other - sums[best]) / kPaths);
}

}  // namespace

ChosenPlanes ChoosePlanes(const MatchingCosts& costs, const Image<uint16_t>& tones, bool with_lead,
                          InterruptFlag interrupted) {
  Matcher matcher(costs, tones);
  matcher.Sweep(1, interrupted);
  matcher.Sweep(-1, interrupted);
  const int width = costs.rect.width(), height = costs.rect.height();
  ChosenPlanes chosen{Image<float>(width, height), Image<uint8_t>(width, height),
                      with_lead ? Image<uint16_t>(width, height) : Image<uint16_t>()};
  for (int y = 0; y < height && !IsSet(interrupted); ++y)
    for (int x = 0; x < width; ++x) {
      const uint16_t* sums = matcher.SumsAt(x, y);
      const int best = static_cast<int>(std::min_element(sums, sums + costs.planes) - sums);
      chosen.place.at(x, y) = PlaceOf(sums, best, costs.planes);
      chosen.cost.at(x, y) = costs.At(x, y)[best];
      if (with_lead) chosen.lead.at(x, y) = LeadOf(sums, best, costs.planes);
    }
  return chosen;
}

}  // namespace lf
