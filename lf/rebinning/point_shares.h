// How much of each lens point is asked for, all over the plate: the others do without it. Given at
// nodes; between them it is interpolated.
#pragma once

#include <cstddef>
#include <vector>

#include "lf/core/geometry.h"
#include "lf/rebinning/frame_rays.h"
#include "lf/rebinning/lens_points.h"

namespace lf {

// Nodes along a side of the plate, the first and the last on the middles of its outermost elements.
class NodeAxis {
 public:
  // One node.
  explicit NodeAxis(int size_px) : NodeAxis(size_px, 1) {}
  // So many, evenly; and some more close to both ends, where what LF images see may end.
  NodeAxis(int size_px, int count);

  int count() const { return static_cast<int>(nodes_px_.size()); }
  int size_px() const { return static_cast<int>(places_.size()); }
  double node_px(int node) const { return nodes_px_[node]; }

  // Between which nodes an element is, and how far from the first to the second.
  struct Place {
    int first = 0;
    int second = 0;
    float fraction = 0;
  };
  const Place& PlaceOf(int element) const { return places_[element]; }

 private:
  std::vector<double> nodes_px_;
  std::vector<Place> places_;  // of all elements
};

struct PointShares {
  NodeAxis columns;
  NodeAxis rows;
  size_t point_count = 0;     // of all sets, one set after the other
  std::vector<float> values;  // [rows][columns][point_count], 0 to 1

  size_t node_count() const { return static_cast<size_t>(columns.count()) * rows.count(); }
  // Of `count` points from `first` on, at an element.
  void At(int x, int y, size_t first, size_t count, float* out) const;
  // Squares with elements that ask for some, or have such within reach_px.
  AskedSquares Squares(double reach_px) const;
  // Of one of them alone.
  PointShares OfPoint(size_t point) const;
  // Of each set, how much of its points is asked for: one after the other.
  PointShares MeansOfSets(const LensPointSets& points) const;
  // Whether any of these is asked for by an element of the rectangle.
  bool IsAny(const PixelRect& rect, size_t first, size_t count) const;
};

}  // namespace lf
