// SPDX-License-Identifier: Apache-2.0
// Convex polygons in the lens plane, in world units.
#pragma once

#include <utility>
#include <vector>

#include "lf/core/geometry.h"

namespace lf {

class ConvexPolygon {
 public:
  ConvexPolygon() = default;
  //   vertices  the corners in counter-clockwise order
  explicit ConvexPolygon(std::vector<Vec2> vertices) : vertices_(std::move(vertices)) {}

  static ConvexPolygon SquareAround(const Vec2& middle, double half_side);

  bool empty() const { return vertices_.empty(); }

  // Keeps only the points p of the polygon with normal . p <= offset. Returns true if this removes
  // a part of the polygon.
  bool Clip(const Vec2& normal, double offset);

  // Returns the distance of the farthest vertex from `point`; 0 if there are no vertices.
  double FarthestFrom(const Vec2& point) const;

  // Returns the least and the largest value of normal . p of the points p. There must be vertices.
  std::pair<double, double> Extent(const Vec2& normal) const;

  double Area() const;

  // Returns the area of the intersection of the polygon with the disk of this radius around the
  // origin.
  double AreaInDisk(double radius) const;

 private:
  std::vector<Vec2> vertices_;
  std::vector<Vec2> kept_;  // memory that Clip() uses again
};

}  // namespace lf
