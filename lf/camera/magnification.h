// SPDX-License-Identifier: Apache-2.0
// How large the pixels of an LF image are in a frame.
#pragma once

#include "lf/camera/pinhole.h"
#include "lf/camera/render_camera.h"

namespace lf {

// Returns the magnification, the width of an LF pixel in elements: the square root of the area, in
// elements, that the LF pixel covers on the plate. The magnification is computed at nine points of
// the plate. The result is the smallest value at the points that the LF image shows, or the
// smallest of all values if the LF image shows none of these points. Returns 1 if the magnification
// is undefined at all nine points.
double Magnification(const PinholeCamera& lf_camera, const RenderCamera& render_camera);

// Largest width of an element, in LF pixels, at which rendering averages all LF pixels that the
// element covers. Wider elements use only some of their LF pixels.
inline constexpr double kWidestElement_px = 16;

// Returns how many LF pixels wide an element is: 1 / Magnification().
inline double ElementWidth_px(const PinholeCamera& lf_camera, const RenderCamera& render_camera) {
  return 1 / Magnification(lf_camera, render_camera);
}

}  // namespace lf
