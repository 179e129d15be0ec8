// From an LF pixel to the sensor plate, as linear forms on the pixel position.
//
// For a fixed (LF camera, render camera) every quantity of doc/ray.md, 1-5, is a linear form on
// p = (x + 0.5, y + 0.5, 1)^T, or a quotient of two. Kernels take spans and addresses from these
// forms, selection takes polygons; nothing is inverted or intersected per ray.
//
// d = R^T K^-1 p is the ray's direction, c its LF camera's centre, c' the lens centre, f the
// render camera's forward axis, X the point on the focus plane n.X = h.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "lf/camera/aperture.h"
#include "lf/camera/pinhole.h"
#include "lf/camera/render_camera.h"
#include "lf/core/geometry.h"

namespace lf {

struct RayForms {
  PixelForm forward;   // f.d; the ray runs forward where > 0
  PixelForm plane;     // n.d; 0 where the ray is parallel to the focus plane
  PixelForm sensor_x;  // element position = (sensor_x p, sensor_y p) / (front p)
  PixelForm sensor_y;
  PixelForm front;  // f.(X - c') times n.d; X is before the lens where front p has plane p's sign
  PixelForm lens_right;  // lens position = (lens_right p, lens_up p) / (forward p)
  PixelForm lens_up;
};

RayForms MakeRayForms(const PinholeCamera& lf_camera, const RenderCamera& render_camera);
// The forms of one LF camera in many frames, which share its directions.
//   direction  R^T K^-1 of the LF camera
RayForms MakeRayForms(const Mat3& direction, const Vec3& centre_world,
                      const RenderCamera& render_camera);

// Half-planes of LF pixels: a ray can be accepted only where `form p <= 0` for all of them. They
// are the projected lens and focus regions of thesis Fig. 4.5, written as the edges that bound
// them, so nothing has to be projected through the plane of the LF camera. Each side of n.d = 0 has
// half-planes of its own: plane_sign is the sign of n.d on that side, +1 or -1.

// Half-planes of the side, of forward and front, and of the four edges of the plate, each edge
// moved outwards by margin_px.
inline constexpr size_t kPlateHalfPlanes = 7;
std::array<PixelForm, kPlateHalfPlanes> PlateHalfPlanes(const RayForms& forms,
                                                        const RenderCamera& render_camera,
                                                        int plane_sign, double margin_px);

// LensHalfPlane() is the half-plane of an edge of the lens polygon (for a disk, of its
// circumscribed 16-gon), moved outwards by margin_w. LensHalfPlanes() are those of all edges, moved
// by a share of the radius. They are valid where rays run forward.
inline PixelForm LensHalfPlane(const RayForms& forms, const ApertureEdge& edge, double margin_w) {
  return edge.normal.x() * forms.lens_right + edge.normal.y() * forms.lens_up -
         (edge.distance_w + margin_w) * forms.forward;
}
std::vector<PixelForm> LensHalfPlanes(const RayForms& forms, const RenderCamera& render_camera,
                                      double relative_margin);

}  // namespace lf
