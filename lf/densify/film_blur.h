// SPDX-License-Identifier: Apache-2.0
// How far what the frames of a film show is out of focus.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "lf/camera/render_camera.h"
#include "lf/core/geometry.h"

namespace lf {

// Returns by how many elements the copies of a point lie apart in a frame that two LF cameras show
// at a unit of distance across the optical axis: f |z - z_f|, where f is the focal length in
// elements, z the inverse depth of the point, and z_f that at which the element of the point is in
// focus. In the frame with the largest one, it is the number that 3 % of the points exceed, in the
// median over the LF images, but at least a quarter of what half a percent exceed: some points are
// wrong matches, and others are lights far out of focus. A single LF image can only raise the
// latter by a tenth. None if no frame shows enough points.
//   points  of the scene, in world coordinates, [LF image that shows them][point]
std::optional<double> CopiesPerDistance(std::span<const RenderCamera> frames,
                                        std::span<const std::vector<Vec3>> points);

}  // namespace lf
