// SPDX-License-Identifier: Apache-2.0
// Places for virtual LF cameras among recorded ones.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "lf/core/geometry.h"
#include "lf/densify/natural_neighbours.h"

namespace lf {

// A place for a virtual LF camera. The LF cameras tell the light there by interpolation, or by a
// small extrapolation.
struct LatticePlace {
  Vec2 place = Vec2::Zero();
  // Weighted mean of the neighbours: `place`, or the nearest place in the convex hull of the
  // points.
  Vec2 inside = Vec2::Zero();
  std::vector<WeightedPoint> neighbours;  // NaturalNeighbours() of `inside`
};

// Returns the place with its neighbours. If all points are on one line, `inside` is the nearest
// place between two of them.
//   points  one or more
LatticePlace PlaceAmong(std::span<const Vec2> points, const Vec2& place);

// Returns the places of a hexagonal lattice, with this distance between neighbours, that lie in the
// convex hull of the points or at most `outside` away from it, without those that are nearer than
// half the distance to one of the points.
std::vector<LatticePlace> LatticeAmong(std::span<const Vec2> points, double distance,
                                       double outside);

// Returns the distance at which a lattice among the points has at most about `count` places.
double DistanceForPlaces(std::span<const Vec2> points, double count);

// Returns true if the points are equal or on a line, so that there is no place between them.
bool AreOnOneLine(std::span<const Vec2> points);

}  // namespace lf
