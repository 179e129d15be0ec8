// SPDX-License-Identifier: Apache-2.0
// The convex hull of points of the plane.
#pragma once

#include <span>
#include <vector>

#include "lf/core/geometry.h"

namespace lf {

// Returns the corners of the convex hull counter-clockwise, without points on its edges. If all
// points are equal or on a line, returns one or two points. (Andrew's monotone chains.)
std::vector<Vec2> ConvexHull(std::span<const Vec2> points);

}  // namespace lf
