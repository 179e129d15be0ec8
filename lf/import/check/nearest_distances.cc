// SPDX-License-Identifier: Apache-2.0
#include "lf/import/check/nearest_distances.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

namespace lf {
namespace {

constexpr size_t kLeafSize = 8;
constexpr size_t kPointsPerTask = 1024;

// A kd-tree, stored in `order_`, a permutation of the points' indices. The middle entry of each
// range of `order_` is the median along the axis in which the range is widest; entries before it
// have smaller or equal coordinates along that axis. The two halves beside it are the subtrees.
class KdTree {
 public:
  explicit KdTree(std::span<const Vec3> points)
      : points_(points), order_(points.size()), axis_(points.size()) {
    std::iota(order_.begin(), order_.end(), uint32_t{0});
    Build(0, order_.size());
  }

  double SquaredDistanceToNearestOther(uint32_t index) const {
    double best = std::numeric_limits<double>::infinity();
    Search(0, order_.size(), index, &best);
    return best;
  }

 private:
  void Build(size_t begin, size_t end) {
    if (end - begin <= kLeafSize) return;
    Eigen::AlignedBox3d box;
    for (size_t i = begin; i < end; ++i) box.extend(points_[order_[i]]);
    Eigen::Index axis = 0;
    box.sizes().maxCoeff(&axis);
    const size_t middle = begin + (end - begin) / 2;
    const auto at = [&](size_t i) { return order_.begin() + static_cast<ptrdiff_t>(i); };
    std::nth_element(at(begin), at(middle), at(end),
                     [&](uint32_t a, uint32_t b) { return points_[a][axis] < points_[b][axis]; });
    axis_[middle] = static_cast<uint8_t>(axis);
    Build(begin, middle);
    Build(middle + 1, end);
  }

  void Try(size_t place, uint32_t index, double* best) const {
    if (order_[place] == index) return;
    *best = std::min(*best, (points_[order_[place]] - points_[index]).squaredNorm());
  }

  void Search(size_t begin, size_t end, uint32_t index, double* best) const {
    if (end - begin <= kLeafSize) {
      for (size_t i = begin; i < end; ++i) Try(i, index, best);
      return;
    }
    const size_t middle = begin + (end - begin) / 2;
    const int axis = axis_[middle];
    const double offset = points_[index][axis] - points_[order_[middle]][axis];
    Try(middle, index, best);
    const bool before = offset < 0;
    before ? Search(begin, middle, index, best) : Search(middle + 1, end, index, best);
    if (offset * offset < *best)
      before ? Search(middle + 1, end, index, best) : Search(begin, middle, index, best);
  }

  std::span<const Vec3> points_;
  std::vector<uint32_t> order_;
  std::vector<uint8_t> axis_;
};

}  // namespace

std::vector<double> NearestDistances(std::span<const Vec3> points, ThreadPool& pool) {
  const KdTree tree(points);
  std::vector<double> distances(points.size());
  const size_t task_count = (points.size() + kPointsPerTask - 1) / kPointsPerTask;
  pool.ForEach(task_count, [&](size_t task) {
    const size_t end = std::min(points.size(), (task + 1) * kPointsPerTask);
    for (size_t i = task * kPointsPerTask; i < end; ++i)
      distances[i] = std::sqrt(tree.SquaredDistanceToNearestOther(static_cast<uint32_t>(i)));
  });
  return distances;
}

}  // namespace lf
