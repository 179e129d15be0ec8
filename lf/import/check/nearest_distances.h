// SPDX-License-Identifier: Apache-2.0
// Computes nearest-neighbour distances, which tell the spacing of a capture. A million cameras take
// seconds.
#pragma once

#include <span>
#include <vector>

#include "lf/core/geometry.h"
#include "lf/core/parallel.h"

namespace lf {

// Returns the distance from each point to its nearest neighbour, in the order of `points`; 0 if
// another point has the same position, infinity for a single point. The distances are exact. A
// kd-tree finds them in n log n time for points in a line, a plane or space.
std::vector<double> NearestDistances(std::span<const Vec3> points, ThreadPool& pool);

}  // namespace lf
