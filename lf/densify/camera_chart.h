// SPDX-License-Identifier: Apache-2.0
// The LF cameras around a camera as points of a plane. In a capture that surrounds the scene, each
// camera has a chart of its own, so that no plane has to hold the whole capture.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "lf/camera/pinhole.h"
#include "lf/core/geometry.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// The plane passes through the centre of a camera and is normal to its optical axis. Each LF camera
// is projected onto it along the line to a point in the middle of the camera's picture. LF cameras
// whose points are near to one another therefore see the scene from similar directions, even if
// their distances from it differ.
struct CameraChart {
  std::vector<uint32_t> ids;  // LF cameras that the chart shows, ascending
  std::vector<Vec2> points;   // [ids]: x to the right, y down, in world units; the camera is at 0
};

// Returns the chart around a camera. It shows the LF cameras that see the point (or would see it in
// an image twice as large) from a direction at most kMostAside_deg away from the optical axis.
//   camera            without lens distortion, or an LF camera
//   inverse_distance  of the point along the optical axis; 0: it is infinitely far
inline constexpr double kMostAside_deg = 60;
CameraChart ChartAround(const LightField& light_field, const PinholeCamera& camera,
                        double inverse_distance);

// Returns the inverse distance at which a camera's chart looks at the subject; 0 if there is none,
// or if it is not in front of the camera.
//   subject  AxesMeetingPoint() of the light field
double InverseDistanceOf(const PinholeCamera& camera, const std::optional<Vec3>& subject);

// Returns, for each LF camera, those that its LF image is compared with: the nearest one in each of
// eight directions of its chart, up to four times as far as usual, or at least the nearest four.
// None but the nearest two see the subject from a direction more than 22 degrees away. If the
// chart shows no other LF camera, they are the two nearest ones. There are none if all LF cameras
// are at one position.
std::vector<std::vector<uint32_t>> CompareWith(const LightField& light_field,
                                               const std::optional<Vec3>& subject);

}  // namespace lf
