// SPDX-License-Identifier: Apache-2.0
// Derives from the poses alone how dense a capture is and what it looks at.
#pragma once

#include <functional>
#include <optional>

#include "lf/camera/pinhole.h"
#include "lf/core/geometry.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// Returns the median distance from an LF camera to its nearest neighbour, in world units; 0 if all
// cameras have one position. It is measured at fewer than 1,000 cameras spread over the light
// field. Cameras at the same position are no neighbours: brackets, bursts and tracks that cross
// repeat positions.
double MedianSpacing(const LightField& light_field);

// Returns how many pixels of an LF image apart the copies are as which a frame, focused at focus_w,
// shows a point at the depth depth_w: F b |1/focus_w - 1/depth_w|, where F is the focal length in
// pixels and b the distance between neighbouring LF cameras. Copies more than about a pixel apart
// are visible. depth_w may be infinite.
double CopiesApart_px(double fx_px, double spacing_w, double focus_w, double depth_w);

// Among the LF cameras for which `is_wanted` returns true, returns the one nearest to the mean
// position of all LF cameras. Returns the nearest of all cameras if `is_wanted` is not given or
// true for none. `is_wanted` is called in order of distance, nearest camera first. The light field
// must have a camera.
LfImageId MiddleCamera(const LightField& light_field,
                       const std::function<bool(LfImageId)>& is_wanted = {});

// Returns the mean of the cameras' up directions, with length 1, or the zero vector if the
// directions almost cancel (the mean is shorter than 0.1).
Vec3 MeanUpWorld(const LightField& light_field);

// Returns the angle in radians, 0 or more, by which the camera leans to the side: the angle between
// its up direction and the projection of `up_world` onto its image plane. Returns 0 if the camera
// looks almost along `up_world` or against it. `up_world` must have length 1, or be the zero vector
// (the result is then 0).
double RollOf(const PinholeCamera& camera, const Vec3& up_world);

// Returns the ray through the middle of the image, with a direction of length 1. It is the optical
// axis unless the principal point is off-axis, as in rectified slabs. For lenses with distortion it
// is always the optical axis.
Ray CentralRay(const PinholeCamera& camera);

// Returns the point that is nearest to the lines of the central rays: a least squares fit, repeated
// without the tenth of the lines that are farthest from it. Uses fewer than 40,000 cameras, spread
// over the light field. nullopt if there are fewer than two cameras, or if the lines are so nearly
// parallel that no point can be found.
std::optional<Vec3> PointNearestToAxes(const LightField& light_field);

// Returns PointNearestToAxes(), or nullopt unless this point is in front of nine tenths of the
// cameras that were left in the fit.
std::optional<Vec3> AxesMeetingPoint(const LightField& light_field);

// How far LF cameras extend beside a camera, along its right and its up axis, in world units.
struct Reach {
  double right_w = 0;
  double up_w = 0;
};
// Returns, for each axis of `camera`, the 80th percentile of the distances along this axis from
// `camera` to the `count` LF cameras nearest to it (all if there are fewer). `count` must exceed 0,
// and the light field must have LF cameras.
Reach CaptureReach(const LightField& light_field, const PinholeCamera& camera, size_t count);

}  // namespace lf
