// Finds the depth of the subject of an LF image from points of a reconstruction that it shows, for
// scenes whose pixels do not tell the depth.
#pragma once

#include <span>

#include "lf/camera/pinhole.h"
#include "lf/core/geometry.h"
#include "lf/focus/find_subject.h"

namespace lf {

// Returns the depths around which most points lie, by weight: a point counts more the nearer it is
// to the middle of the image. Points behind the camera or outside its image do not count; the
// number of the others is textured_count, and also place_count. The best depth is sure if 24 points
// lie there, with a quarter of the whole weight and at least 1.5 times the weight at the next best
// depth.
Subject FindPointSubject(const PinholeCamera& camera, std::span<const Vec3> points_world);

// Returns true if the camera sees at least 24 points, and at most 1 % of them are within 10 % of
// this depth. If pixels tell this depth, it is then likely that of a pattern that repeats, a
// mirror, or a mark on the lens.
bool PointsContradict(const PinholeCamera& camera, std::span<const Vec3> points_world,
                      double depth_w);

}  // namespace lf
