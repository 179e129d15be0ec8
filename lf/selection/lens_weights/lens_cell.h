// SPDX-License-Identifier: Apache-2.0
// Computes the Voronoi cell of one place among points of the lens plane. Internal to this folder.
#pragma once

#include <span>

#include "lf/core/geometry.h"
#include "lf/selection/lens_weights/convex_polygon.h"
#include "lf/selection/lens_weights/point_grid.h"

namespace lf {

// Keeps the part of `cell` that is nearer to `place` than to any of the points elsewhere.
// Considers one point after the other. Calls met(i) for every point that cuts off a part of the
// polygon that the points before it have left, and same(i) for every point that is exactly at
// `place`.
//   grid  a grid of the points
template <class Met, class Same>
void CutCell(const Vec2& place, std::span<const Vec2> points, const PointGrid& grid, const Met& met,
             const Same& same, ConvexPolygon* cell) {
  double reach = 2 * cell->FarthestFrom(place);  // points farther than this cut nothing off
  for (int ring = 0; ring <= grid.ring_count() && !cell->empty(); ++ring) {
    if (grid.LeastDistanceOf(ring) > reach) break;
    const double reach2 = reach * reach;
    grid.ForEachInRing(place, ring, [&](size_t i) {
      const Vec2 across = points[i] - place;
      if (across.squaredNorm() > reach2 || cell->empty()) return;
      if (across == Vec2::Zero())
        same(i);
      else if (cell->Clip(across, across.dot(0.5 * (place + points[i]))))
        met(i);
    });
    reach = 2 * cell->FarthestFrom(place);
  }
}

}  // namespace lf
