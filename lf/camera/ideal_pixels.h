// The pixels of an LF camera with its lens distortion undone, without resampling its image.
//
// The *ideal position* of a pixel is where a pinhole with the same K would record its ray: q = K d
// with d the direction of the ray in camera axes. It is homogeneous, since a fish-eye sees beyond
// 90 degrees, where no finite position is left. Without distortion q = (x + 0.5, y + 0.5, 1). Every
// linear form of camera/ray_forms.h applies to q as it does to pixels.
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

// Of continuous pixel position (x, y), by iteration to rounding: the reference. `map` is that of
// k.distortion. None where no ray arrives.
std::optional<Vec3> IdealPosition(const Intrinsics& k, const DistortionMap& map, double x_px,
                                  double y_px);

// Pixels [x_begin, x_end) of a scanline, whose ideal positions lie on a Bezier arc of degree 5; it
// runs evenly from the left border of the first pixel to the right border of the last. A linear
// form on the arc lies between its values at the control points.
struct IdealArc {
  int32_t x_begin = 0;
  int32_t x_end = 0;
  static constexpr int kControls = 6;
  Vec3 control[kControls];

  // Of the centre of pixel x.
  double Parameter(int x) const {
    return (x - x_begin + 0.5) / static_cast<double>(x_end - x_begin);
  }
  Vec3 At(double t) const;
};

// Pixels of a rectangle, whose ideal positions lie on a Bezier patch of degree 5 by 5, which runs
// evenly from its left to its right and from its upper to its lower border. A linear form on the
// patch lies between its values at the control points.
struct IdealPatch {
  static constexpr int kControls = IdealArc::kControls;
  PixelRect rect;
  Vec3 control[kControls][kControls];  // [row][column]

  // The centres of scanline y, one of rect's.
  IdealArc Scanline(int y) const { return ArcAt(Parameter(y)); }
  double Parameter(int y) const { return (y + 0.5 - rect.y_begin) / rect.height(); }
  // At v from 0, the upper border, to 1.
  IdealArc ArcAt(double v) const;
};

// Those of the control points for the value at t, from 0 to 1; their sum is 1.
using BezierWeights = std::array<double, IdealArc::kControls>;
BezierWeights BezierWeightsAt(double t);

// All pixels of a camera with distortion, in patches that are true to kTolerance_px.
class IdealPixels {
 public:
  // Distance, in LF pixels, from a pixel to where the camera would record what its ideal position
  // stands for: between the points where patches were made to fit (checked where they miss most).
  static constexpr double kTolerance_px = 3e-5;

  explicit IdealPixels(const Intrinsics& k);

  // Without overlap. Pixels that no patch covers have no ray.
  const std::vector<IdealPatch>& patches() const { return patches_; }
  size_t size_bytes() const { return patches_.capacity() * sizeof(IdealPatch); }

 private:
  std::vector<IdealPatch> patches_;
};

}  // namespace lf
