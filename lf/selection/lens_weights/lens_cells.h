// The lens as an integral over its area (doc/ray.md, "What is added"): the share of it that each LF
// camera stands for.
#pragma once

#include <span>
#include <vector>

#include "lf/camera/aperture.h"
#include "lf/core/geometry.h"
#include "lf/selection/lens_weights/covered_region.h"

namespace lf {

// Returns the share of each cell: a camera stands for its Voronoi cell, the part of the opening
// that is nearer to it than to any other camera, clipped by the covered region. Exact except for
// rounding (1e-12). If there is a point, in the opening or beside it, the sum of shares is the
// covered part of the opening, because cells of points beside it reach in. Points at the same place
// have equal shares. Takes about a microsecond for each point.
//   points    where rays of the LF cameras meet the lens plane, in lens coordinates; finite, any
//             number and arrangement
//   aperture  radius_w > 0
std::vector<double> CellShares(std::span<const Vec2> points, const Aperture& aperture,
                               const CoveredRegion& covered = {});

// Returns the share of each hat: every point of the opening is seen by the cameras around it, in
// the proportions in which a camera at that point would take its cell from theirs (natural
// neighbours; Sibson 1981). The share of a camera is its mean over `sample_count` points of the
// opening. These weights are for openings that are small compared with the distances of the
// cameras, pinholes included: a picture between cameras is interpolated, and moves smoothly from
// one to the next. Outside of all cameras, the nearest ones share the whole. The sum is 1 if there
// is a point. Points at the same place have equal shares. Takes some microseconds for each sample.
//   aperture  radius_w >= 0; one sample is used if it is 0
std::vector<double> HatShares(std::span<const Vec2> points, const Aperture& aperture,
                              int sample_count = 64);

}  // namespace lf
