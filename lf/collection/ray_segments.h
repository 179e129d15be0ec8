// From spans of accepted pixels to segments with cubic addresses. Internal to collection.
#pragma once

#include "lf/camera/ideal_pixels.h"
#include "lf/camera/ray_forms.h"
#include "lf/collection/scatter.h"

namespace lf {

// Collects the segments of one (LF camera, render camera) into a plan, by y, then x.
class SegmentMaker {
 public:
  // Cubics are true to this, in elements, before rounding to single precision.
  static constexpr double kTolerance = 1e-5;

  SegmentMaker(const RayForms& forms, int plate_width, int plate_height);

  // Pixels [x_begin, x_end) of scanline y, without lens distortion. The segments are pieces of
  // blocks [k 2^n, (k + 1) 2^n) of pixels, so that no cut of the work changes an address.
  void AddSpan(int y, int x_begin, int x_end);

  // Pixels [x_begin, x_end) of an arc of scanline y.
  void AddOnArc(int y, int x_begin, int x_end, const IdealArc& arc);

  ScatterPlan Take();

 private:
  // Element position over the distance, in pixels, from the middle of a piece of a scanline.
  struct Cubics {
    double x[4];
    double y[4];
  };
  void AddInBlock(int y, int x_begin, int x_end, int block_begin, int block_size);
  void AddOnPart(int y, int x_begin, int x_end, const IdealArc& arc, int part_begin, int part_end);
  bool FitToPart(const IdealArc& arc, int part_begin, int part_end, Cubics* cubics) const;
  void Push(int y, int x_begin, int x_end, double middle, const Cubics& cubics);

  RayForms forms_;
  ScatterPlan plan_;
};

}  // namespace lf
