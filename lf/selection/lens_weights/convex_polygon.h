// Convex polygons in the lens plane.
#pragma once

#include <vector>

#include "lf/core/geometry.h"

namespace lf {

class ConvexPolygon {
 public:
  ConvexPolygon() = default;
  //   vertices  counter-clockwise
  explicit ConvexPolygon(std::vector<Vec2> vertices) : vertices_(std::move(vertices)) {}

  static ConvexPolygon SquareAround(const Vec2& middle, double half_side);

  bool empty() const { return vertices_.empty(); }

  // Keeps the part where normal . p <= offset. Returns true if this is not the whole polygon.
  bool Clip(const Vec2& normal, double offset);

  // Distance of the farthest vertex from the point; 0 if there is none.
  double FarthestFrom(const Vec2& point) const;

  double Area() const;

  // Area of the part within the disk with this radius around the origin.
  double AreaInDisk(double radius) const;

 private:
  std::vector<Vec2> vertices_;
};

}  // namespace lf
