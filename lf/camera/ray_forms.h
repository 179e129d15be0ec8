// SPDX-License-Identifier: Apache-2.0
// Maps LF pixels to the sensor plate by linear forms on the pixel position.
//
// For a fixed pair of LF camera and render camera, every quantity of doc/ray.md, steps 1-5, is a
// linear form on p = (x + 0.5, y + 0.5, 1)^T, or a quotient of two such forms. Collection kernels
// compute spans and addresses from these forms, selection computes polygons; no ray needs an
// inversion or an intersection of its own.
//
// R, K and c are the rotation, calibration matrix and centre of the LF camera; d = R^T K^-1 p is
// the ray's direction; c' is the lens centre and f the forward axis of the render camera; X is the
// point where the ray meets the focus plane n.X = h.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "lf/camera/aperture.h"
#include "lf/camera/pinhole.h"
#include "lf/camera/render_camera.h"
#include "lf/core/geometry.h"

namespace lf {

// Returns the matrix M that maps the direction d of a ray to the place, times f.d, where the ray
// meets a plane normal to f, seen from a point of this plane (doc/ray.md, Geometry, 5).
//   offset  vector from that point to a point of the ray
inline Mat3 ToPlane(const Vec3& offset, const Vec3& f) {
  return offset * f.transpose() - f.dot(offset) * Mat3::Identity();
}

struct RayForms {
  // f.d, for the ray's direction d and the render camera's forward axis f. The ray runs forward
  // where this form is above 0.
  PixelForm forward;
  // n.d, for the normal n of the focus plane; 0 where the ray is parallel to the focus plane.
  PixelForm plane;
  // The ray meets the sensor plate at the element position (sensor_x p, sensor_y p) / (front p).
  PixelForm sensor_x;
  PixelForm sensor_y;
  // f.(X - c') times n.d, where X is the ray's point on the focus plane and c' the lens centre. X
  // is in front of the lens where `front p` and `plane p` have equal signs.
  PixelForm front;
  // The ray meets the lens plane at (right, up) = (lens_right p, lens_up p) / (forward p), in world
  // units from the lens centre.
  PixelForm lens_right;
  PixelForm lens_up;
  // The ray meets the plane of the hood likewise, from its centre; unset if there is no hood.
  PixelForm hood_right;
  PixelForm hood_up;
};

RayForms MakeRayForms(const PinholeCamera& lf_camera, const RenderCamera& render_camera);
// Returns the forms of an LF camera with the given centre. Saves time if the forms of one LF camera
// are made for many frames, because all of them use the same `direction`.
//   direction  R^T K^-1 of the LF camera; maps p to the direction of its ray in the world
RayForms MakeRayForms(const Mat3& direction, const Vec3& centre_world,
                      const RenderCamera& render_camera);

// A half-plane of LF pixels p is given by a form: a ray can be accepted only if `form p <= 0` for
// all half-planes that are valid for the ray. Together the half-planes bound the part of the LF
// image that sees the lens and the filmed region (thesis Fig. 4.5). The thesis projects lens and
// region into the LF image, which fails for points beside the LF camera, in the plane through its
// centre and normal to its axis; half-planes need no projection. Rays whose direction d has n.d >
// 0, with the normal n of the focus plane, and rays with n.d < 0 have different half-planes:
// plane_sign, +1 or -1, is the sign of n.d.

// Returns the half-planes of the conditions plane_sign `plane p` >= 0, `forward p` >= 0 and
// plane_sign `front p` >= 0 (the form of a condition a >= 0 is -a), and the half-planes of the four
// edges of the plate, or of the camera's window. Each edge is moved outwards by margin_px elements.
inline constexpr size_t kPlateHalfPlanes = 7;
std::array<PixelForm, kPlateHalfPlanes> PlateHalfPlanes(const RayForms& forms,
                                                        const RenderCamera& render_camera,
                                                        int plane_sign, double margin_px);

// LensHalfPlane() returns the half-plane of one edge of the lens polygon (for a disk, of its
// circumscribed 16-gon), moved outwards by margin_w. LensHalfPlanes() returns the half-planes of
// all edges, moved outwards by `relative_margin` times the lens radius. These half-planes are valid
// only for rays that run forward.
inline PixelForm LensHalfPlane(const RayForms& forms, const ApertureEdge& edge, double margin_w) {
  return edge.normal.x() * forms.lens_right + edge.normal.y() * forms.lens_up -
         (edge.distance_w + margin_w) * forms.forward;
}
std::vector<PixelForm> LensHalfPlanes(const RayForms& forms, const RenderCamera& render_camera,
                                      double relative_margin);
// Returns the half-planes of the edges of the hood likewise, with `relative_margin` times its
// radius; none if there is no hood.
std::vector<PixelForm> HoodHalfPlanes(const RayForms& forms, const RenderCamera& render_camera,
                                      double relative_margin);

}  // namespace lf
