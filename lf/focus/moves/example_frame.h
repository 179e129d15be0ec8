// SPDX-License-Identifier: Apache-2.0
// The picture that an example path starts with: level, within the view of an LF camera.
#pragma once

#include "lf/camera/pinhole.h"
#include "lf/core/geometry.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// The largest width of the frames of an example path. A first look at photographs of 13 megapixels
// should not take 13 megapixels.
inline constexpr int kMostFrameWidth_px = 1920;

// Returns the vertical, upwards, with length 1: the direction most nearly at right angles to the
// right axes of all LF cameras, because the right axis of a level camera is horizontal. If these
// axes hardly differ, returns MeanUpWorld(), which may be the zero vector.
Vec3 VerticalWorld(const LightField& light_field);

// Returns the up direction with which a picture of `camera` is level: the vertical, or the up
// direction of `camera` itself if the vertical is unknown or `camera` is rolled by more than 30
// degrees against it.
Vec3 LevelUpWorld(const LightField& light_field, const PinholeCamera& camera);

// Returns the largest frame within the LF camera's view, at most as wide as the LF image and at
// least a quarter as wide, for a camera of the same position and direction with this up direction.
//
// The frame has the proportions of the LF image. Its elements are as large as the LF pixels in the
// middle of the LF image, or larger if it would otherwise be wider than kMostFrameWidth_px. Its
// principal point is its middle, unless an off-centre principal point of the LF camera would cost
// more than 2 % of its width: then the middle of the frame is that of the LF image.
Intrinsics InscribedFrame(const PinholeCamera& camera, const Vec3& up_world);

// Returns the frame around the middle of `frame` that has this share of its width and height.
Intrinsics CroppedFrame(const Intrinsics& frame, double share);

}  // namespace lf
