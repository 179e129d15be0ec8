// How far each point is from the others: the spacing of a capture, of a million cameras in seconds.
#pragma once

#include <span>
#include <vector>

#include "lf/core/geometry.h"
#include "lf/core/parallel.h"

namespace lf {

// From each point to the nearest other one, in the order of `points`; 0 where another has the same
// position. Infinite for a single point. Exact, by a kd-tree: n log n, for points in a line, a
// plane or space.
std::vector<double> NearestDistances(std::span<const Vec3> points, ThreadPool& pool);

}  // namespace lf
