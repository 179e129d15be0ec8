// SPDX-License-Identifier: Apache-2.0
// Sorts points of the plane into square buckets, about one in each, so that they can be visited
// roughly in the order of their distance from a place. Internal to this folder.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "lf/core/geometry.h"

namespace lf {

class PointGrid {
 public:
  //   points  must outlive the grid
  explicit PointGrid(std::span<const Vec2> points);

  // Side of a bucket: about the distance between neighbouring points.
  double bucket_size() const { return bucket_size_; }

  // Indices of all points, bucket by bucket.
  const std::vector<size_t>& sorted() const { return sorted_; }

  // Number of the last ring that may have points. Ring 0 of a place is the bucket nearest to it.
  // Ring k consists of the buckets whose larger distance in columns or rows from this bucket is k.
  int ring_count() const { return std::max(columns_, rows_); }

  // Returns a lower bound of the distance of a ring's points from the place that it surrounds.
  double LeastDistanceOf(int ring) const { return std::max(0, ring - 1) * bucket_size_; }

  // Calls use(i) for the index i of each point in a ring around `centre`, which may be anywhere in
  // the plane.
  template <class Use>
  void ForEachInRing(const Vec2& centre, int ring, const Use& use) const {
    const int column = ColumnOf(centre), row = RowOf(centre);
    for (int y = std::max(0, row - ring); y <= std::min(rows_ - 1, row + ring); ++y) {
      const bool is_edge = std::abs(y - row) == ring;
      const int step = is_edge || ring == 0 ? 1 : 2 * ring;
      for (int x = column - ring; x <= column + ring; x += step) {
        if (x < 0 || x >= columns_) continue;
        const size_t bucket = static_cast<size_t>(y) * columns_ + x;
        for (size_t i = begin_[bucket]; i < begin_[bucket + 1]; ++i) use(sorted_[i]);
      }
    }
  }

  // Returns the distance from a place to the nearest point; infinity if there is none.
  //   leave_out_same  true: points exactly at the place are ignored
  double DistanceToNearest(const Vec2& place, bool leave_out_same = false) const {
    double nearest = INFINITY;
    for (int ring = 0; ring <= ring_count() && LeastDistanceOf(ring) < nearest; ++ring)
      ForEachInRing(place, ring, [&](size_t i) {
        const double distance = (points_[i] - place).norm();
        if (distance > 0 || !leave_out_same) nearest = std::min(nearest, distance);
      });
    return nearest;
  }

 private:
  int ColumnOf(const Vec2& point) const { return Bucket(point.x() - corner_.x(), columns_); }
  int RowOf(const Vec2& point) const { return Bucket(point.y() - corner_.y(), rows_); }
  int Bucket(double distance, int count) const {
    return static_cast<int>(std::clamp(distance / bucket_size_, 0.0, count - 1.0));
  }

  std::span<const Vec2> points_;
  Vec2 corner_ = Vec2::Zero();
  double bucket_size_ = 1;
  int columns_ = 1;
  int rows_ = 1;
  std::vector<size_t> begin_;   // [rows * columns + 1]: index in sorted_ of a bucket's first point
  std::vector<size_t> sorted_;  // indices of points, by bucket
};

}  // namespace lf
