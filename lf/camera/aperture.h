// SPDX-License-Identifier: Apache-2.0
// The opening of the lens: a disk, an ellipse, or a polygon of straight or rounded blades inscribed
// in it (thesis 4.3.3, "Simulating Aperture Shapes").
//
// Lens coordinates: origin at the lens centre, right and up as the photographer behind the camera
// sees them, world units.
#pragma once

#include <cstdint>
#include <vector>

#include "lf/core/geometry.h"

namespace lf {

struct Aperture {
  double radius_w = 0;      // radius of the circle around the opening; 0: a pinhole
  int blades = 0;           // 0: round; >= 3: polygon with a vertex straight up at rotation 0
  double rotation_rad = 0;  // counter-clockwise as the photographer sees it (right towards up)
  // Height of the opening divided by its width, as of an anamorphic lens: above 1, the opening is
  // narrower by this factor; below 1, it is lower.
  double ratio = 1;
  // 0: blades are straight; 1: they form the circle; between: their edges are arcs through the
  // vertices, whose middles are this share of the way from the chord to the circle.
  double roundness = 0;

  bool IsDisk() const { return ratio == 1 && (blades == 0 || roundness == 1); }
  // True if the edges are straight, so that there is one for each blade.
  bool IsPlainPolygon() const { return blades > 0 && ratio == 1 && roundness == 0; }
};

// The limits of Aperture::ratio are 1 / kMostRatio and kMostRatio.
inline constexpr double kMostRatio = 10;
// The largest number of blades of a lens with a hood (render_camera.h), because planners keep a bit
// for each edge of both.
inline constexpr int kMostBladesInHood = 40;

// Relative tolerance of the rim. The rim counts as inside, because LF cameras of regular grids
// often lie exactly on it. In a disk, the squared length of a point may exceed the squared radius
// by this share. In a polygon, the distance of a point along the normal of an edge may exceed
// ApertureEdge::distance_w by half of this share (doc/ray.md).
inline constexpr double kRimTolerance = 1e-9;

// One edge of the opening: normal . l <= distance_w for every point l of the opening, in lens
// coordinates; |normal| = 1.
struct ApertureEdge {
  Vec2 normal = Vec2::UnitX();
  double distance_w = 0;
};

// Returns the vertices of the polygon in lens coordinates, counter-clockwise; empty for a disk. An
// opening with curved edges is the convex polygon of up to 40 vertices that is returned
// (doc/ray.md).
std::vector<Vec2> Vertices(const Aperture& aperture);
// Returns the same or, for a disk, the vertices of a polygon that has its area.
std::vector<Vec2> RimVertices(const Aperture& aperture);

// Returns the edges of the polygon. For a disk, returns the edges of the regular polygon with
// `disk_edge_count` edges that is circumscribed about the disk.
inline constexpr int kDiskEdges = 16;
std::vector<ApertureEdge> Edges(const Aperture& aperture, int disk_edge_count = kDiskEdges);
// Radius of the circle through the vertices of the polygon with kDiskEdges edges that is
// circumscribed about a disk of radius 1: 1 / cos(pi / kDiskEdges).
inline constexpr double kDiskPolygonRadius = 1.0195911582083184;

// Returns true if the point (right, up) lies in the opening or on its rim.
bool Contains(const Aperture& aperture, const Vec2& point_lens);

// Tests many points as the function Contains() does, but computes the edges of a polygon only once.
class ApertureTest {
 public:
  explicit ApertureTest(const Aperture& aperture);
  bool Contains(const Vec2& point_lens) const {
    if (edges_.empty()) return point_lens.squaredNorm() <= radius2_w2_;
    return IsWithinEdges(point_lens);
  }

 private:
  bool IsWithinEdges(const Vec2& point_lens) const;

  double radius2_w2_;                // for a disk: squared radius, times 1 + kRimTolerance
  std::vector<ApertureEdge> edges_;  // for a polygon; empty for a disk
};

// Returns the area of the opening in squared world units.
double Area(const Aperture& aperture);

// Returns `count` points spread uniformly over the opening: the R2 low-discrepancy sequence,
// shifted by random offsets that depend on `seed`. A point (a, b) of the sequence is mapped to the
// disk by radius_w sqrt(a) (cos 2 pi b, sin 2 pi b) (thesis Eq. 4.7), or to the polygon by
// triangles around its centre. Equal arguments give equal points on every machine.
std::vector<Vec2> SampleLens(const Aperture& aperture, int count, uint64_t seed = 0);

}  // namespace lf
