// SPDX-License-Identifier: Apache-2.0
#include "lf/selection/lens_weights/point_grid.h"

namespace lf {

PointGrid::PointGrid(std::span<const Vec2> points) : points_(points) {
  if (!points.empty()) {
    Vec2 low = points[0], high = points[0];
    for (const Vec2& p : points) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    corner_ = low;
    const Vec2 size = high - low;
    const auto count = static_cast<double>(points.size());
    // The second term matters if the points are on a line, because their bounding box then has no
    // area.
    bucket_size_ = std::max(std::sqrt(size.x() * size.y() / count), size.maxCoeff() / count);
    if (bucket_size_ == 0) bucket_size_ = 1;
    columns_ = static_cast<int>(size.x() / bucket_size_) + 1;
    rows_ = static_cast<int>(size.y() / bucket_size_) + 1;
  }
  begin_.assign(static_cast<size_t>(columns_) * rows_ + 1, 0);
  const auto bucket_of = [this](const Vec2& p) {
    return static_cast<size_t>(RowOf(p)) * columns_ + ColumnOf(p);
  };
  for (const Vec2& p : points) ++begin_[bucket_of(p) + 1];
  for (size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
  sorted_.resize(points.size());
  std::vector<size_t> next(begin_.begin(), begin_.end() - 1);
  for (size_t i = 0; i < points.size(); ++i) sorted_[next[bucket_of(points[i])]++] = i;
}

}  // namespace lf
