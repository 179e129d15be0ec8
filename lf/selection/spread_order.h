// SPDX-License-Identifier: Apache-2.0
// The order of LF images of which every beginning, every part and every shard is spread evenly over
// the LF cameras, and over those of them that a lens sees (thesis 4.2.1). A mean over such a
// beginning is much nearer to the mean over all LF images than that over as many random ones.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lf/light_field/model/light_field.h"
#include "lf/selection/capture_surface.h"

namespace lf {

// Returns the indices of points in such an order, which depends on the points and the seed alone.
//
// The unit square is divided into a rectangle for each point: the points are cut in two, again and
// again, by lines between them near the median of their longer extent, and the square is cut in the
// same proportion. Each rectangle therefore has the same area and, if the points are a grid, its
// place in the grid. The k-th point of the sequence (spread_sequence.h) lies in a rectangle, whose
// point comes at rank k. If this point has a rank already, the next free one is taken: in the
// smallest part of the cuts that contains the rectangle and a free point.
// Takes about a second for a million points.
//   stream  as for SpreadSequence()
std::vector<uint32_t> OrderOfPoints(std::span<const SurfacePoint> points, uint64_t seed,
                                    uint64_t stream = 0);

// Returns the LF images of a light field, as LfImageId::value, in such an order, which depends on
// positions and the seed alone.
//
// LF images of exactly one pose follow each other, because those of a bracket
// (light_field/model/brackets.h) send all rays of the pose only together. Recorded and virtual LF
// images are ordered by themselves and then merged, so that a beginning has the same share of both.
// The order of recorded LF images is therefore the same with and without virtual ones.
std::vector<uint32_t> SpreadOrder(const LightField& light_field, uint64_t seed);

}  // namespace lf
