// What the poses alone tell of a capture: how dense it is, what it looks at.
#pragma once

#include <optional>

#include "lf/camera/pinhole.h"
#include "lf/capture/light_field.h"
#include "lf/core/geometry.h"

namespace lf {

// Median distance from an LF camera to its nearest neighbour, in world units; of at most 500
// cameras spread over the light field. 0 for fewer than two.
double MedianSpacing(const LightField& light_field);

// The LF camera nearest to the mean position. The light field must have one.
LfImageId MiddleCamera(const LightField& light_field);

// The point nearest to the optical axes (least squares, with the worst tenth left out), if they
// converge: in front of most cameras, and not so far away that the axes are parallel for all that
// their spread tells.
std::optional<Vec3> AxesMeetingPoint(const LightField& light_field);

// How far the positions of the `count` LF cameras nearest to `camera` reach from it along its
// right and up axes: the 80th percentile of the distances, in world units.
struct Reach {
  double right_w = 0;
  double up_w = 0;
};
Reach CaptureReach(const LightField& light_field, const PinholeCamera& camera, size_t count);

}  // namespace lf
