// SPDX-License-Identifier: Apache-2.0
// How large the pixels of an LF image are in a frame.
#pragma once

#include <array>
#include <optional>

#include "lf/camera/pinhole.h"
#include "lf/camera/render_camera.h"
#include "lf/core/geometry.h"

namespace lf {

// The points of a frame's focus plane from which Magnification() is computed. They are the same for
// all LF cameras, so that a caller that asks about many makes them once.
class MagnificationPoints {
 public:
  explicit MagnificationPoints(const RenderCamera& render_camera);

 private:
  friend double Magnification(const PinholeCamera& lf_camera, const MagnificationPoints& points);

  // The focus points of a place on the plate: in the middle, and half an element to the left, to
  // the right, above and below.
  struct Cross {
    Vec3 middle, left, right, above, below;
  };
  // A place has no points if one of these is undefined (FocusPointOfElement()).
  std::array<std::optional<Cross>, 9> places_;
  Vec3 forward_world_;
};

// Returns the magnification, the width of an LF pixel in elements: the square root of the area, in
// elements, that the LF pixel covers on the plate. The magnification is computed at nine points of
// the plate. The result is the smallest value at the points that the LF image shows, or the
// smallest of all values if the LF image shows none of these points. Returns 1 if the magnification
// is undefined at all nine points.
double Magnification(const PinholeCamera& lf_camera, const MagnificationPoints& points);
inline double Magnification(const PinholeCamera& lf_camera, const RenderCamera& render_camera) {
  return Magnification(lf_camera, MagnificationPoints(render_camera));
}

// Largest width of an element, in LF pixels, at which rendering averages all LF pixels that the
// element covers. Wider elements use only some of their LF pixels.
inline constexpr double kWidestElement_px = 16;

// Returns how many LF pixels wide an element is: 1 / Magnification().
inline double ElementWidth_px(const PinholeCamera& lf_camera, const RenderCamera& render_camera) {
  return 1 / Magnification(lf_camera, render_camera);
}
inline double ElementWidth_px(const PinholeCamera& lf_camera, const MagnificationPoints& points) {
  return 1 / Magnification(lf_camera, points);
}

}  // namespace lf
