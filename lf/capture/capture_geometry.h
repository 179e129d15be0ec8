// What the poses alone tell of a capture: how dense it is, what it looks at.
#pragma once

#include <functional>
#include <optional>

#include "lf/camera/pinhole.h"
#include "lf/capture/light_field.h"
#include "lf/core/geometry.h"

namespace lf {

// Median distance from an LF camera to its nearest neighbour, in world units; of at most 500
// cameras spread over the light field. 0 for fewer than two.
double MedianSpacing(const LightField& light_field);

// The LF camera nearest to the mean position, of those that are wanted, which are asked from the
// nearest on. If none is: the nearest of all. The light field must have one.
LfImageId MiddleCamera(const LightField& light_field,
                       const std::function<bool(LfImageId)>& is_wanted = {});

// The direction that is up for most: the mean of the cameras' own, of length 1; 0 if they have none
// in common.
Vec3 MeanUpWorld(const LightField& light_field);

// Returns how much the camera leans to the side: the angle, from 0 on, between its up direction and
// the part of `up_world` that its image shows. It is 0 if the camera looks along that.
double RollOf(const PinholeCamera& camera, const Vec3& up_world);

// The ray through the middle of the image, of length 1: the optical axis, but for cameras with an
// off-axis principal point, as rectified slabs have. (Of lenses with distortion: the optical axis.)
Ray CentralRay(const PinholeCamera& camera);

// The point nearest to the central rays taken as lines (least squares, with the worst tenth left
// out; of at most 20,000 cameras). None if they are parallel for all that their spread tells.
std::optional<Vec3> PointNearestToAxes(const LightField& light_field);

// The same, if the cameras look at it: it is in front of nine of ten.
std::optional<Vec3> AxesMeetingPoint(const LightField& light_field);

// How far the positions of the `count` LF cameras nearest to `camera` reach from it along its
// right and up axes: the 80th percentile of the distances, in world units.
struct Reach {
  double right_w = 0;
  double up_w = 0;
};
Reach CaptureReach(const LightField& light_field, const PinholeCamera& camera, size_t count);

}  // namespace lf
