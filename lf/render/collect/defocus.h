// SPDX-License-Identifier: Apache-2.0
// Tells which pixels of a recorded LF image are out of focus in a frame (doc/densify.md, "The
// guard"). There, the pictures of neighbouring LF cameras lie side by side in the frame.
#pragma once

#include <cstddef>
#include <cstdint>

#include "lf/camera/pinhole.h"
#include "lf/core/geometry.h"
#include "lf/core/image.h"
#include "lf/light_field/model/lf_depths.h"
#include "lf/light_field/model/lf_pixels.h"

namespace lf {

// The range of the depths around each pixel, which is made once for all frames.
struct NearbyDepths {
  LfDepths depths;  // `numbers` are empty
  // Least and greatest number of the 3 x 3 numbers around each one, [height][width][1]. Both are
  // LfDepths::kUnknown if one of the nine is unknown.
  Image<uint16_t> least;
  Image<uint16_t> greatest;

  bool empty() const { return least.empty(); }
};
NearbyDepths NearbyDepthsOf(const LfDepths& depths);

// Returns the size of the result of DefocusOf().
inline size_t DefocusBytes(const PixelRect& rect) {
  return static_cast<size_t>(rect.pixel_count()) * LfPixels::kRgbLanes * sizeof(uint16_t);
}

// A pixel whose pictures in two neighbouring LF cameras lie at most kInFocus units apart in the
// frame is in focus, from kOutOfFocus units on it is out of focus, and in part between them.
inline constexpr double kInFocus = 0.6;
inline constexpr double kOutOfFocus = 1.2;

// Returns the unit in LF pixels: a pixel of virtual LF images or an element of the frame, whichever
// is larger. Pictures that are nearer to one another show no copies in the elements, and virtual LF
// images are not sharper.
//   divisor  of virtual LF images
double DefocusUnitPx(int divisor, const Intrinsics& lf_camera, const Intrinsics& frame);

// Returns the defocus of the pixels `rect`, largest of the 3 x 3 numbers around each pixel:
//
//   clamp((|z - z_f| f d / u - kInFocus) / (kOutOfFocus - kInFocus), 0, 1)
//
// where z is the inverse depth of the pixel, z_f that of the focus plane along the pixel's ray, f
// the focal length in pixels, d the distance between neighbouring LF cameras, and u the unit. It is
// 1 if a depth is unknown. The result has the values of opacities (LfPixels::kTransparent is 0,
// kOpaque is 1) in all three colours, and no mask, so that it is collected like colours.
//   nearby             empty: no depth is known
//   camera_distance_w  distance between neighbouring recorded LF cameras around the frame's lens
//   memory             pixels that are no longer needed; their memory is reused
LfPixels DefocusOf(const NearbyDepths& nearby, const PinholeCamera& lf_camera,
                   const Plane& focus_plane, double camera_distance_w, double unit_px,
                   const PixelRect& rect, LfPixels memory = {});

}  // namespace lf
