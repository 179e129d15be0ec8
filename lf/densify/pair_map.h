// SPDX-License-Identifier: Apache-2.0
// Maps the pixels of one pinhole camera without distortion to the pixels of another.
#pragma once

#include "lf/camera/pinhole.h"

namespace lf {

// The position of a point in the image of the second camera is
//   (u, v) = (a0 x + a1 y + a2 + z b0, a3 x + a4 y + a5 + z b1) / w,  w = a6 x + a7 y + a8 + z b2
// where (x, y) is its position in the image of the first camera and z its inverse depth there. The
// inverse depth for the second camera is z / w. The point is in front of the second camera if w is
// above 0. (The homography that a plane of constant depth causes: Collins, "A space-sweep approach
// to true multi-image matching", CVPR 1996.)
//
// Numbers are floats: every machine computes the same bits, since no multiply-add is fused.
struct PairMap {
  float a[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  float b[3] = {0, 0, 0};

  struct Place {
    float u_px = 0, v_px = 0;
    float w = 0;
  };
  // Returns the place of a point; it has no meaning unless w > 0.
  Place At(float x_px, float y_px, float z) const {
    const float w = a[6] * x_px + a[7] * y_px + a[8] + z * b[2];
    const float inverse = 1 / w;
    return {(a[0] * x_px + a[1] * y_px + a[2] + z * b[0]) * inverse,
            (a[3] * x_px + a[4] * y_px + a[5] + z * b[1]) * inverse, w};
  }
};

// Both cameras must be without lens distortion.
PairMap MapBetween(const PinholeCamera& first, const PinholeCamera& second);

// Returns the shift, in pixels of `first`, that a unit of inverse depth causes between the images
// of two cameras: focal length times the distance of the cameras across the axis of `first`.
double ShiftPerInverseDepth(const PinholeCamera& first, const PinholeCamera& second);

}  // namespace lf
