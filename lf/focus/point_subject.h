// Finds the depth of what a camera looks at from points of a reconstruction that it sees, for
// scenes whose pixels do not tell it.
#pragma once

#include <span>

#include "lf/camera/pinhole.h"
#include "lf/core/geometry.h"
#include "lf/focus/find_subject.h"

namespace lf {

// Returns the depths around which most points lie, by weight: a point counts the more, the nearer
// it is to the middle of the image. Points behind the camera and outside its image do not count.
// textured_count is the number of the others, and place_count too. Sure: 24 points lie at the best
// depth, with a quarter of the weight of all and half as much again as the next best depth has.
Subject FindPointSubject(const PinholeCamera& camera, std::span<const Vec3> points_world);

// Returns true if the camera sees at least 24 points and at most 1 % of them are within 10 % of
// this depth: what pixels tell is then likely a pattern that repeats, a mirror, or a mark on the
// lens.
bool PointsContradict(const PinholeCamera& camera, std::span<const Vec3> points_world,
                      double depth_w);

}  // namespace lf
