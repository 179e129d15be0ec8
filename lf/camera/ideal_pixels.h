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

// Returns the ideal position of continuous pixel position (x, y), by iteration to rounding. This is
// the reference. `map` must be the map of k.distortion. None if no ray arrives.
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

  // Parameter of the arc at the centre of pixel x.
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

  // The arc through the pixel centres of scanline y, which must be in `rect`.
  IdealArc Scanline(int y) const { return ArcAt(Parameter(y)); }
  double Parameter(int y) const { return (y + 0.5 - rect.y_begin) / rect.height(); }
  // The arc at v, which is 0 at the upper border and 1 at the lower one.
  IdealArc ArcAt(double v) const;
};

// Weights of the control points in the arc's point at t, from 0 to 1. Their sum is 1.
using BezierWeights = std::array<double, IdealArc::kControls>;
BezierWeights BezierWeightsAt(double t);

// All pixels of a camera with distortion, in patches that are accurate to kTolerance_px.
class IdealPixels {
 public:
  // Largest error of a patch: the distance, in LF pixels, between a pixel and where the camera
  // would record the ray of its ideal position. Patches are exact at the points that they are made
  // from, and checked where their error is largest (kQuinticWorstPlaces).
  static constexpr double kTolerance_px = 3e-5;

  explicit IdealPixels(const Intrinsics& k);

  // The patches do not overlap. Pixels that no patch covers have no ray.
  const std::vector<IdealPatch>& patches() const { return patches_; }

 private:
  std::vector<IdealPatch> patches_;
};

}  // namespace lf
