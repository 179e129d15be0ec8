// SPDX-License-Identifier: Apache-2.0
// The LF cameras around a camera as points of a plane. In a capture that surrounds the scene, each
// camera has a chart of its own, so that no plane has to hold the whole capture.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
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

// Returns LF cameras none of which sees the subject from a direction nearer than kLeastApart_deg to
// that of another one, ascending; all if there is no subject. Images of a video are so near to one
// another that each pair tells little about depth, and there are hundreds.
//   subject  AxesMeetingPoint() of the light field
inline constexpr double kLeastApart_deg = 2.5;
std::vector<uint32_t> FarEnoughApart(const LightField& light_field,
                                     const std::optional<Vec3>& subject);

// Returns the chart around a camera. It shows those of the LF cameras `among` that see the point
// (or would see it in an image twice as large) from a direction at most kMostAside_deg away from
// the optical axis.
//   among             ascending
//   camera            without lens distortion, or an LF camera
//   inverse_distance  of the point along the optical axis; 0: it is infinitely far
inline constexpr double kMostAside_deg = 60;
CameraChart ChartAround(const LightField& light_field, std::span<const uint32_t> among,
                        const PinholeCamera& camera, double inverse_distance);

// Returns the inverse distance at which a camera's chart looks at the subject; 0 if there is none,
// or if it is not in front of the camera.
//   subject  AxesMeetingPoint() of the light field
double InverseDistanceOf(const PinholeCamera& camera, const std::optional<Vec3>& subject);

// Returns, for each LF camera, those of the LF cameras `among` that its LF image is compared with:
// the nearest one in each of eight directions of its chart, up to four times as far as usual, or at
// least the nearest four.
// None but the nearest two see the subject from a direction more than 22 degrees away. If the
// chart shows no other LF camera, they are the two nearest ones. There are none if all LF cameras
// are at one position.
//   among  ascending
std::vector<std::vector<uint32_t>> CompareWith(const LightField& light_field,
                                               std::span<const uint32_t> among,
                                               const std::optional<Vec3>& subject);

}  // namespace lf
