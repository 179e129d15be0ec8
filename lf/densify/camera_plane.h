// The positions of LF cameras as points of a plane, and which of them are neighbours.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lf/core/geometry.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// LF cameras as points of a plane: of the plane parallel to their mean image plane, through their
// mean position. If LF cameras look in directions more than kMostTurn_deg from their mean, like
// those around an object, they are first put on a sphere around the point that they look at, which
// is unrolled: a point's distance and direction from the middle are the length and the direction of
// the arc on the sphere (azimuthal equidistant projection).
struct CameraPlane {
  RigidTransform mean_cam_from_world;  // x along the plane, z normal to it
  std::vector<Vec2> points;            // [camera], in world units: x to the right, y down
  bool is_unrolled = false;            // true: the points were on a sphere
  double widest_deg = 0;  // largest angle between the axis of an LF camera and the mean axis
};
inline constexpr double kMostTurn_deg = 30;
// kInput: LF cameras look in directions too far apart, and do not look at one point from one side.
Result<CameraPlane> CameraPlaneOf(const LightField& light_field);

// Returns the rotation matrix nearest to a weighted sum of rotation matrices.
Mat3 MeanRotation(std::span<const Mat3> rotations, std::span<const double> weights);

// Returns, for each point, the points that its LF image is compared with: the nearest one in each
// of eight directions, up to four times as far as usual, or at least the nearest four.
std::vector<std::vector<uint32_t>> CompareWith(std::span<const Vec2> points);

// A point beside another and its weight.
struct WeightedPoint {
  uint32_t index = 0;
  double weight = 0;
};

// Returns the natural neighbours of `place`: the points whose Voronoi cells it would border on. The
// weight of a neighbour is the length of that border divided by its distance (Belikov et al., "The
// non-Sibsonian interpolation", 1997). The weights add up to 1, and the weighted mean of the
// neighbours is `place`. The neighbours are sorted, the largest weight first. Returns none if
// `place` is outside the convex hull of the points.
//   points  may include `place` itself, which is then the only neighbour
std::vector<WeightedPoint> NaturalNeighbours(std::span<const Vec2> points, const Vec2& place);

// A place for a virtual LF camera. The LF cameras tell the light there by interpolation, or by a
// small extrapolation.
struct LatticePlace {
  Vec2 place = Vec2::Zero();
  // Weighted mean of the neighbours: `place`, or the nearest place in the convex hull of the
  // points.
  Vec2 inside = Vec2::Zero();
  std::vector<WeightedPoint> neighbours;  // NaturalNeighbours() of `inside`
};

// Returns the places of a hexagonal lattice, with this distance between neighbours, that lie in the
// convex hull of the points or at most `outside` away from it, without those that are nearer than
// half the distance to one of the points.
std::vector<LatticePlace> LatticeAmong(std::span<const Vec2> points, double distance,
                                       double outside);

// Returns the median of the distances from a point to the nearest other point.
double MedianDistance(std::span<const Vec2> points);

}  // namespace lf
