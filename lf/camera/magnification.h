// How large the pixels of an LF image are in a frame.
#pragma once

#include "lf/camera/pinhole.h"
#include "lf/camera/render_camera.h"

namespace lf {

// Returns the magnification, the number of elements per LF pixel along an edge: the square root of
// the area, in elements, that an LF pixel covers on the plate. It is computed at nine points of the
// plate. The result is the smallest value at the points that the LF image shows, or the smallest of
// all if it shows none of them. Returns 1 if there is no value at any of them.
double Magnification(const PinholeCamera& lf_camera, const RenderCamera& render_camera);

// Width, in LF pixels, of the largest element that is the mean of all its LF pixels. Larger
// elements leave out some.
inline constexpr double kWidestElement_px = 16;

// Returns how many LF pixels wide an element is: 1 / Magnification().
inline double ElementWidth_px(const PinholeCamera& lf_camera, const RenderCamera& render_camera) {
  return 1 / Magnification(lf_camera, render_camera);
}

}  // namespace lf
