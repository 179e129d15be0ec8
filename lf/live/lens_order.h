// SPDX-License-Identifier: Apache-2.0
// The order in which a live picture takes LF images.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "lf/core/geometry.h"

namespace lf {

// Returns indices of `count` of the points, or of all if there are fewer, in an order of which
// every beginning is spread evenly: the first point is the one nearest to the origin, and each next
// point is the farthest from all points before it (farthest-point sampling; Gonzalez, "Clustering
// to Minimize the Maximum Intercluster Distance", 1985). Of equally far points the one with the
// smallest index comes first.
//
// Live pictures weigh their LF images by the cells of these alone. This order is then as good as
// OrderOfPoints() (selection/spread_order.h), and can prefer points; without such weights it is
// worse, unless the number of points is a power of four.
//   preferred_count  the distance of a point before this index counts twice
std::vector<size_t> FarthestPointOrder(std::span<const Vec2> points, size_t count,
                                       size_t preferred_count = 0);

// The order in which LF images are taken for a lens.
struct LensOrder {
  // Indices of points: first those inside, in the order of FarthestPointOrder(), then the others,
  // the nearest to the lens centre first.
  std::vector<size_t> indices;
  size_t inside_count = 0;
};
//   points  for each LF image, the point of the lens plane through which its rays pass, in lens
//           coordinates
// Points up to a tenth of the radius outside of the lens count as inside, because LF images at the
// rim have a share of the lens. `count` and preferred_count as for FarthestPointOrder().
LensOrder OrderOverLens(std::span<const Vec2> points, double radius_w, size_t count,
                        size_t preferred_count = 0);

}  // namespace lf
