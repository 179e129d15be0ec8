// Derives from the poses alone how dense a capture is and what it looks at.
#pragma once

#include <functional>
#include <optional>

#include "lf/camera/pinhole.h"
#include "lf/core/geometry.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// Returns the median distance from an LF camera to its nearest neighbour, in world units, from at
// most 500 cameras spread over the light field. 0 for fewer than two cameras.
double MedianSpacing(const LightField& light_field);

// Returns the LF camera that is nearest to the mean position among those for which `is_wanted`
// returns true, or nearest of all if there is none. `is_wanted` is called from the nearest camera
// on. The light field must have a camera.
LfImageId MiddleCamera(const LightField& light_field,
                       const std::function<bool(LfImageId)>& is_wanted = {});

// Returns the mean of the cameras' up directions, with length 1, or the zero vector if the cameras
// have no common one.
Vec3 MeanUpWorld(const LightField& light_field);

// Returns the angle, 0 or more, by which the camera leans to the side: the angle between its up
// direction and the projection of `up_world` onto its image. It is 0 if the camera looks along
// `up_world`.
double RollOf(const PinholeCamera& camera, const Vec3& up_world);

// Returns the ray through the middle of the image, with a direction of length 1. It is the optical
// axis unless the principal point is off-axis, as in rectified slabs. For lenses with distortion it
// is always the optical axis.
Ray CentralRay(const PinholeCamera& camera);

// Returns the point nearest to the lines of the central rays (least squares without the worst
// tenth, from at most 20,000 cameras), or nullopt if the lines are too nearly parallel to tell.
std::optional<Vec3> PointNearestToAxes(const LightField& light_field);

// As PointNearestToAxes(), but nullopt unless the point is in front of nine of ten cameras.
std::optional<Vec3> AxesMeetingPoint(const LightField& light_field);

// How far the `count` LF cameras nearest to `camera` are from it along its right and its up axis:
// the 80th percentiles of the distances, in world units.
struct Reach {
  double right_w = 0;
  double up_w = 0;
};
Reach CaptureReach(const LightField& light_field, const PinholeCamera& camera, size_t count);

}  // namespace lf
