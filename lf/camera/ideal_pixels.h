// SPDX-License-Identifier: Apache-2.0
// Undoes the lens distortion of an LF camera for the positions of its pixels, without resampling
// its image.
//
// The *ideal position* of a pixel is the position at which a pinhole with the same K would record
// its ray: q = K d, where d is the direction of the ray in camera axes. It is in homogeneous
// coordinates, because a fish-eye sees directions beyond 90 degrees, which have no finite position.
// Without distortion q = (x + 0.5, y + 0.5, 1). Every linear form of camera/ray_forms.h applies to
// q as it applies to the pixel positions of a camera without distortion.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "lf/camera/distortion.h"
#include "lf/camera/pinhole.h"
#include "lf/core/geometry.h"

namespace lf {

// Returns the ideal position of continuous pixel position (x, y); none if no ray arrives there. The
// result is exact up to rounding errors (by iteration if the model has no closed formula), and is
// the reference for the patches below. `map` must be the map of k.distortion.
std::optional<Vec3> IdealPosition(const Intrinsics& k, const DistortionMap& map, double x_px,
                                  double y_px);

// Pixels [x_begin, x_end) of a scanline, whose ideal positions lie on a Bezier arc of degree 5. The
// parameter of the arc grows linearly from 0 at the left border of the first pixel to 1 at the
// right border of the last. On the arc, a linear form has no value outside the range of its values
// at the control points.
struct IdealArc {
  int32_t x_begin = 0;
  int32_t x_end = 0;
  static constexpr int kControls = 6;
  Vec3 control[kControls];

  // Returns the parameter of the arc at the centre of pixel x.
  double Parameter(int x) const {
    return (x - x_begin + 0.5) / static_cast<double>(x_end - x_begin);
  }
  Vec3 At(double t) const;
};

// Pixels of a rectangle, whose ideal positions lie on a Bezier patch of degree 5 by 5. The
// parameters of the patch grow linearly from 0 at its left and upper border to 1 at its right and
// lower border. On the patch, a linear form has no value outside the range of its values at the
// control points.
struct IdealPatch {
  static constexpr int kControls = IdealArc::kControls;
  PixelRect rect;
  Vec3 control[kControls][kControls];  // [row][column]

  // Returns the arc through the centres of the pixels of scanline y, which must be in `rect`.
  IdealArc Scanline(int y) const { return ArcAt(Parameter(y)); }
  // Returns the vertical parameter of the patch at the centres of the pixels of scanline y.
  double Parameter(int y) const { return (y + 0.5 - rect.y_begin) / rect.height(); }
  // Returns the arc at the vertical parameter v: 0 at the upper border of `rect`, 1 at the lower
  // one.
  IdealArc ArcAt(double v) const;
};

// Returns the weights of the control points of an arc for its point at parameter t, in [0, 1]. The
// sum of the weights is 1.
using BezierWeights = std::array<double, IdealArc::kControls>;
BezierWeights BezierWeightsAt(double t);

// All pixels of a camera with distortion, in patches that are accurate to kTolerance_px.
class IdealPixels {
 public:
  // Largest error of a patch: the distance, in LF pixels, between a pixel and the position at which
  // the camera would record the ray of the pixel's ideal position on the patch. A patch is exact at
  // the points that it is made from. Its error is checked at the parameters where such an error is
  // largest (kQuinticWorstPlaces in core/quintic.h).
  static constexpr double kTolerance_px = 3e-5;

  explicit IdealPixels(const Intrinsics& k);

  // The patches do not overlap. Pixels that no patch covers have no ray.
  const std::vector<IdealPatch>& patches() const { return patches_; }

 private:
  std::vector<IdealPatch> patches_;
};

}  // namespace lf
