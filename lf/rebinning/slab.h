// SPDX-License-Identifier: Apache-2.0
// The light slab: two planes that parameterize rays, and the cells that rays are sorted into
// (thesis 2.1.1, 4.3.2).
//
// A ray that cuts the st plane at (s, t) and the uv plane at (u, v), measured along the planes'
// axes from their origins, is in the cell (thesis Eq. 4.3, with cell widths r_st and r_uv for the
// two planes)
//
//   (floor(s / r_st), floor(t / r_st), floor(u / r_uv), floor(v / r_uv))
//
// and the cell stands for the ray through its middle. Light runs from the uv plane to the st plane:
// a ray that cuts the planes in the other order is a different ray, and has no cell.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "lf/camera/pinhole.h"
#include "lf/camera/ray.h"
#include "lf/core/geometry.h"

namespace lf {

struct SlabPlane {
  Vec3 origin_world = Vec3::Zero();
  Vec3 axis_a = Vec3::UnitX();  // both axes are unit vectors, at right angles
  Vec3 axis_b = Vec3::UnitY();

  Vec3 Normal() const { return axis_a.cross(axis_b); }
};

struct Slab {
  SlabPlane st;
  SlabPlane uv;
  double r_st_w = 0;  // width of a cell on the st plane, world units
  double r_uv_w = 0;  // width of a cell on the uv plane, world units
};

// The points (s, t) and (u, v) where a ray cuts the two planes: s, t, u, v, in world units.
using SlabPoint = Eigen::Vector4d;

// Returns the points where a ray cuts the planes; none if the ray is parallel to one of them, or
// runs from the uv plane to the st plane. A ray runs in the direction that its camera looks in,
// against the light.
std::optional<SlabPoint> Parameterize(const Slab& slab, const Ray& ray);

// Returns the ray that starts at (s, t) on the st plane and passes through (u, v) on the uv plane.
Ray RayOfPoint(const Slab& slab, const SlabPoint& point);

// Key of a cell: its four numbers, with kCellOffset added, in 16 bits each, the first in the lowest
// bits. A key is never 0.
using CellKey = uint64_t;
inline constexpr int kCellOffset = 32768;
inline constexpr int kCellAxes = 4;
inline constexpr int kMostCells = 32767;  // cells on either side of the origin, along each axis

// Returns the key of the cell that contains a point whose coordinates are in widths of cells
// instead of world units. Returns none if a coordinate is not in [-kMostCells, kMostCells).
std::optional<CellKey> KeyOf(const SlabPoint& cells);
// Returns the key of the cell that contains a point in world units; none as for KeyOf().
std::optional<CellKey> CellOf(const Slab& slab, const SlabPoint& point);
// Returns the middle of a cell, in world units.
SlabPoint MiddleOf(const Slab& slab, CellKey key);

// The points where the rays of an LF camera cut a slab, as quotients of linear forms in the ideal
// pixel position p (camera/ideal_pixels.h):
//
//   point[k] = numerators[k] p / denominators[k / 2] p
struct SlabForms {
  std::array<PixelForm, kCellAxes> numerators;
  std::array<PixelForm, 2> denominators;  // one for the st plane, one for the uv plane
  // The ray's parameter where it cuts a plane (0: st, 1: uv) is distances[plane] /
  // (denominators[plane] p).
  std::array<double, 2> distances;
};
SlabForms MakeSlabForms(const Slab& slab, const PinholeCamera& lf_camera);
// Like MakeSlabForms(), but points are in widths of cells instead of world units: the cell of the
// ray of a pixel position has the key KeyOf(Parameterize(forms, position)).
SlabForms MakeCellForms(const Slab& slab, const PinholeCamera& lf_camera);

// Returns the same as Parameterize(slab, ray) for the ray of the pixel position, except for
// rounding, and except that the point may be infinite if the ray is parallel to a plane. KeyOf()
// returns none for such a point.
std::optional<SlabPoint> Parameterize(const SlabForms& forms, const Vec3& position);

}  // namespace lf
