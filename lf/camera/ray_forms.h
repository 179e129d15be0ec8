// From an LF pixel to the sensor plate, as linear forms on the pixel position.
//
// For a fixed (LF camera, render camera) every quantity of doc/ray.md, 1-5, is a linear form on
// p = (x + 0.5, y + 0.5, 1)^T, or a quotient of two. Kernels take spans and addresses from these
// forms, selection takes polygons; nothing is inverted or intersected per ray.
//
// d = R^T K^-1 p is the ray's direction, c its LF camera's centre, c' the lens centre, f the
// render camera's forward axis, X the point on the focus plane n.X = h.
#pragma once

#include <vector>

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

// How far RayHalfPlanes reaches beyond the exact conditions, so that rounding never loses a ray.
struct HalfPlaneMargins {
  double lens_relative = 1e-6;  // the lens grows by this share of its radius
  double element_px = 1e-6;     // the plate grows by this on every side
};

// The LF pixels that can contribute, side by side: a ray of the given sign of n.d is accepted only
// where `form p <= 0` for all returned forms. The disk is replaced by its circumscribed 16-gon
// (thesis Fig. 4.5, with the overlap of the projected lens and focus regions written as the
// half-planes that bound both: nothing has to be projected through a camera plane).
std::vector<PixelForm> RayHalfPlanes(const RayForms& forms, const RenderCamera& render_camera,
                                     int plane_sign, const HalfPlaneMargins& margins = {});

}  // namespace lf
