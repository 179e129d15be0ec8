// SPDX-License-Identifier: Apache-2.0
// Finds the depth of the subject of an LF image from the points of a reconstruction that the image
// shows, for scenes whose depth cannot be found from pixels.
#pragma once

#include <span>

#include "lf/camera/pinhole.h"
#include "lf/core/geometry.h"
#include "lf/focus/find_subject.h"

namespace lf {

// Returns the depths around which most points lie. The weight of a point is larger the nearer it is
// to the middle of the image. Points behind the camera or outside its image are not used;
// textured_count and place_count are both the number of the remaining points. The best depth is
// sure if at least 24 points with at least a quarter of the whole weight lie around it, and if its
// weight is at least 1.5 times the weight of the next best depth.
Subject FindPointSubject(const PinholeCamera& camera, std::span<const Vec3> points_world);

// Returns true if the camera sees at least 24 points, and at most 1 % of them are within 10 % of
// `depth_w`. A depth that was found from pixels is then probably wrong: a repeating pattern, a
// mirror, or a mark on the lens causes such depths.
bool PointsContradict(const PinholeCamera& camera, std::span<const Vec3> points_world,
                      double depth_w);

}  // namespace lf
