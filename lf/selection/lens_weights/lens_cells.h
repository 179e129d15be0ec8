// SPDX-License-Identifier: Apache-2.0
// Computes the share of the lens that each LF camera represents, so that a sum over LF cameras
// approximates the integral over the lens area (doc/ray.md, "What is added").
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "lf/camera/aperture.h"
#include "lf/core/geometry.h"
#include "lf/selection/lens_weights/convex_polygon.h"
#include "lf/selection/lens_weights/covered_region.h"

namespace lf {

// Returns, for each point, the area of its Voronoi cell divided by the area of the opening. The
// cell is the part of the opening that is nearer to the point than to any other point, clipped by
// the covered region. Exact except for rounding (1e-12). If there is at least one point, in the
// opening or beside it, the shares sum up to the covered share of the opening, because the cells of
// points beside the opening extend into it. Points at the same place share their cell equally.
// Takes about a microsecond for each point.
//   points    the points where rays of the LF cameras meet the lens plane, in lens coordinates;
//             finite, in any number and arrangement
//   aperture  its radius_w must be above 0
std::vector<double> CellShares(std::span<const Vec2> points, const Aperture& aperture,
                               const CoveredRegion& covered = {});

// Does the same for an opening that is any convex polygon, and for any measure of its parts: their
// area, or the light that they let through. If the measure of the opening is 0, all shares are 0.
using PartMeasure = std::function<double(const ConvexPolygon& part)>;
std::vector<double> CellShares(std::span<const Vec2> points, const ConvexPolygon& opening,
                               const CoveredRegion& covered, const PartMeasure& measure);

// Returns, for each point, the area of its whole Voronoi cell, which may extend beyond the opening,
// divided by the area of the opening. Cells are clipped by the covered region, and by a square that
// contains all points. Otherwise like CellShares(). If there are many points in the opening, the
// shares of those within it sum up to nearly its covered share.
std::vector<double> WholeCellShares(std::span<const Vec2> points, const Aperture& aperture,
                                    const CoveredRegion& covered = {});

// Returns, for each point, its natural-neighbour weight (Sibson 1981), as a mean over
// `sample_count` sample points of the opening. The weights at a sample point are found as follows:
// a new Voronoi cell there would take area from the cells of the cameras around it, and each
// camera's weight is its share of this area. These weights are for openings that are small compared
// with the distances between cameras, and for pinholes: a picture between cameras is interpolated,
// and changes smoothly from one camera to the next. Outside of all cameras, the nearest cameras
// share the whole weight. The sum is 1 if there is at least one point. Points at the same place
// have equal shares. Takes some microseconds for each sample.
//   aperture  its radius_w must be at least 0; if it is 0, only one sample is used
std::vector<double> HatShares(std::span<const Vec2> points, const Aperture& aperture,
                              int sample_count = 64);
// Returns the natural-neighbour weights as a weighted mean over these places of the opening; 0 if
// there are none.
struct LensPlace {
  Vec2 place = Vec2::Zero();
  double weight = 1;  // above 0
};
std::vector<double> HatShares(std::span<const Vec2> points, std::span<const LensPlace> places);

// Returns, for each point, its weight as a weighted mean over these places, which lie beyond the
// points. Each place is divided by a Gaussian around it with the sigma spread_w, so that the points
// nearest to it share it. (Natural neighbours would give a place far beyond the points weights of
// many of them.) The sum is 1 if there are points and places.
std::vector<double> SpreadShares(std::span<const Vec2> points, std::span<const LensPlace> places,
                                 double spread_w);

}  // namespace lf
