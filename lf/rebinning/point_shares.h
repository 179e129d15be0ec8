// SPDX-License-Identifier: Apache-2.0
// The share of the light through each lens point that a frame interpolates between rebinned rays:
// from 0 (the point is not queried) to 1. The share differs from element to element: shares are
// given at nodes on the plate and interpolated between these.
#pragma once

#include <cstddef>
#include <vector>

#include "lf/core/geometry.h"
#include "lf/rebinning/frame_rays.h"
#include "lf/rebinning/lens_points.h"

namespace lf {

// Nodes along a side of the plate. The first and the last node are in the middles of the outermost
// elements; a single node is in the middle of the side.
class NodeAxis {
 public:
  // Makes one node.
  explicit NodeAxis(int size_px) : NodeAxis(size_px, 1) {}
  // Makes `count` nodes at equal distances. If count is 3 or more, adds nodes near both ends,
  // because the field of view of LF images may end there; leaves out nodes that would be less than
  // an element from the first or last node. A side of one element has one node.
  NodeAxis(int size_px, int count);

  int count() const { return static_cast<int>(nodes_px_.size()); }
  int size_px() const { return static_cast<int>(places_.size()); }
  double node_px(int node) const { return nodes_px_[node]; }

  // The two nodes around an element, and the position of the element between them: 0 at the first
  // node, 1 at the second.
  struct Place {
    int first = 0;
    int second = 0;
    float fraction = 0;
  };
  const Place& PlaceOf(int element) const { return places_[element]; }

 private:
  std::vector<double> nodes_px_;
  std::vector<Place> places_;  // one for each element of the side
};

struct PointShares {
  NodeAxis columns;
  NodeAxis rows;
  size_t point_count = 0;  // number of lens points in all sets; points are in the order of the sets
  std::vector<float> values;  // shares at nodes, 0 to 1: [rows][columns][point_count]

  size_t node_count() const { return static_cast<size_t>(columns.count()) * rows.count(); }
  // Writes the shares of lens points [first, first + count) at element (x, y) to out[count].
  void At(int x, int y, size_t first, size_t count, float* out) const;
  // Returns the squares that have an element with a share above 0, or that are within reach_px of
  // such an element. May return a few others.
  AskedSquares Squares(double reach_px) const;
  // Returns the shares of one point alone.
  PointShares OfPoint(size_t point) const;
  // Returns the mean shares of the points of each set, at each node. The result has one point for
  // each set.
  PointShares MeansOfSets(const LensPointSets& points) const;
  // True if one of the points [first, first + count) has a share above 0 at a node around the
  // rectangle. If false, no element of the rectangle queries these points.
  bool IsAny(const PixelRect& rect, size_t first, size_t count) const;
};

}  // namespace lf
