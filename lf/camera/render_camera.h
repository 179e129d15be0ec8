// SPDX-License-Identifier: Apache-2.0
// The thin-lens camera of one frame: the calibration matrix K', rotation R', lens centre c', lens
// and focus plane of doc/ray.md.
#pragma once

#include <optional>

#include "lf/camera/aperture.h"
#include "lf/camera/focal_surface.h"
#include "lf/camera/pinhole.h"
#include "lf/camera/transmission.h"
#include "lf/core/geometry.h"

namespace lf {

// Tilt of the focus plane. At x to the right of the optical axis and u above it, in world units,
// the plane has the depth  g + x tan(horizontal) + u tan(vertical),  where g is the focus distance.
struct FocusTilt {
  double horizontal_rad = 0;
  double vertical_rad = 0;
};

// A round opening of this radius around the optical axis, in a plane in front of the lens
// (camera/hood.h).
struct Hood {
  double distance_w = 0;  // from the lens centre
  double radius_w = 0;    // 0: there is no hood
  bool exists() const { return radius_w > 0; }
};

// The lens and the focus of all frames are changed while their path is opened (PathOptions):
//   OpenFilm(light_field, path, {.aperture_diameter_mm = 9, .focus_distance_w = 2})
// Cameras may also be changed before their frames are rendered:
//   film.path.ChangeCameras([](lf::RenderCamera* camera) {
//     camera->focus_distance_w = 2;
//     camera->focus_plane = lf::FocusPlane(camera->pinhole, 2, camera->focus_tilt);
//     camera->surface = nullptr;  // it would replace the focus plane
//   });
struct RenderCamera {
  PinholeCamera pinhole;  // projects points through the lens centre to elements of the sensor plate
  Aperture aperture;      // in the plane through the lens centre normal to the optical axis
  Plane focus_plane;      // in world coordinates
  Hood hood;
  TransmissionPtr transmission;  // null: the whole opening lets all light through
  // The depth at which each element is in focus, in place of focus_plane, which is then the plane
  // by which the frame is described to people, and by which the filter of an LF image is chosen.
  // Null: all elements are in focus on focus_plane.
  FocalSurfacePtr surface;
  // The elements that take rays. Unset: all. ForEachPiece() sets it.
  std::optional<PixelRect> window;

  // The time of a light field video that the frame shows (light_field/model/time_slices.h). Unset:
  // the path does not move through time, and the light field shows one time.
  std::optional<double> recording_time;

  // The settings that the members above were computed from, for people and metadata.
  double time_s = 0;
  double focal_length_w = 0;
  double sensor_width_w = 0;
  double focus_distance_w = 0;  // from the lens centre to the focus plane, along the optical axis
  FocusTilt focus_tilt;
  double unit_m = 1;  // metres per world unit
};

// Returns the elements that take rays: the window, or the whole plate.
PixelRect ElementsOf(const RenderCamera& camera);

// Returns the camera with one focus plane for all elements: that of its surface at the element
// position (x, y), or focus_plane if there is no surface.
RenderCamera FocusedAsAt(const RenderCamera& camera, double x_px, double y_px);

// Calls body(camera) for the camera or, if it has a surface, for each of its pieces: with the focus
// plane of the piece, its elements as the window, and no surface. Rays and elements are mapped by
// such a camera as by the whole one, so that the pieces together are the frame.
template <class Body>
void ForEachPiece(const RenderCamera& camera, const Body& body) {
  if (!camera.surface) {
    body(camera);
    return;
  }
  RenderCamera of_piece = camera;
  of_piece.surface = nullptr;
  for (const FocalPiece& piece : camera.surface->pieces()) {
    of_piece.window = piece.elements;
    of_piece.focus_plane = PlaneOfPiece(camera.pinhole, piece);
    body(of_piece);
  }
}

// Returns the focus plane at distance g > 0 in front of `camera`, with tilts within +-90 degrees.
Plane FocusPlane(const PinholeCamera& camera, double focus_distance_w, const FocusTilt& tilt);

// Returns the distances from the optical axis to the middle of the picture, to the right and
// upwards, in world units on a plate that does not turn the picture around. They are exactly 0 if
// the principal point is the centre of the plate.
Vec2 ShiftOf(const RenderCamera& camera);

// Replaces the opening by a disk of this radius, and removes hood and transmission, so that rays
// that pass near the lens are accepted.
void OpenUpTo(double radius_w, RenderCamera* camera);
// Returns true if the opening has a ratio or roundness, or the camera a hood. Files state their
// numbers only then.
bool HasShape(const RenderCamera& camera);
// Returns true if these numbers are within their limits.
bool IsShape(const RenderCamera& camera);

// Converts a point of the lens from lens coordinates (right, up) to world coordinates.
Vec3 LensPointWorld(const RenderCamera& camera, const Vec2& point_lens);

// Returns the point of the focus plane, or of the focal surface, that element position (x, y) sees
// through every point of the lens, by the refraction of a thin lens (thesis 2.3.2). None if the
// line from (x, y) through the lens centre meets the tilted plane only behind the lens or never.
std::optional<Vec3> FocusPointOfElement(const RenderCamera& camera, double x_px, double y_px);

}  // namespace lf
