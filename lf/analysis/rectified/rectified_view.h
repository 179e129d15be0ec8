// SPDX-License-Identifier: Apache-2.0
// Resamples LF images into those of pinhole cameras at the same places that all look in one
// direction (thesis 6.2). Only rays that pass the LF camera's centre are needed, so that no depth
// has to be known.
#pragma once

#include <optional>

#include "lf/camera/distortion.h"
#include "lf/camera/pinhole.h"
#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/core/image.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"
#include "lf/storage/load/lf_image_store.h"

namespace lf {

// Returns the intrinsics without distortion and falloff.
Intrinsics PinholeOf(const Intrinsics& k);

// Tells at which positions an LF camera records the rays of a rectified view at its centre.
class RectifiedRays {
 public:
  //   view_rotation  rotation from world axes to those of the view
  //   view           intrinsics of the view, without distortion
  RectifiedRays(const PinholeCamera& lf_camera, const Mat3& view_rotation, const Intrinsics& view);

  // True if the view is the LF image itself: both have the same size, no corner, middle of a border
  // or middle of the view is recorded more than kSame_px from its own position, and the lens has no
  // distortion.
  bool IsSame() const { return is_same_; }
  static constexpr double kSame_px = 1e-3;

  // Returns the position, in pixels of the LF image, at which the ray of a continuous position in
  // the view is recorded. It may lie outside of the LF image. None if the lens has no image of it.
  std::optional<Vec2> RecordedAt(double x_px, double y_px) const;

  // Returns the rectangle of LF pixels that the samples at these positions of the view read: every
  // pixel centre in `rect`, shifted by shift_px along x. Empty if none is within the LF image.
  PixelRect PixelsFor(const PixelRect& rect, double shift_px) const;

 private:
  bool FindSame() const;

  Intrinsics lf_;
  Intrinsics view_;
  Mat3 lf_from_view_;  // from directions in view axes to those in camera axes
  Mat3 inverse_;       // K^-1 of the view
  DistortionMap map_;
  bool is_same_;
};

// Returns the light of an LF image at a continuous position, interpolated by Catmull and Rom's
// cubics between sixteen pixels or, if the outer twelve are not all there, linearly between four.
// A position within RectifiedRays::kSame_px of a pixel centre gives the value of this pixel.
//   light  [height][width][3], NaN where there is none (LightOf())
//   rect   the part of the LF image that `light` covers
// Writes to rgb[3]; NaN if a pixel that is needed is missing.
void SampleLight(const Image<float>& light, const PixelRect& rect, const Vec2& at_px, float* rgb);

// Loads what is needed of an LF image and returns the pixels `rect` of the view as linear light
// [height][width][3] (LightOf()). Each pixel shows the ray through its centre shifted by shift_px
// to the right. Pixels that the LF image does not show, or masks, are NaN. If rays.IsSame() and
// shift_px is 0, values are those of the LF image.
// kInput: the LF image cannot be loaded. kOutput: the machine lacks something.
//   store  a store with Mosaics::kToRgb
Result<Image<float>> LoadRectified(const LightField& light_field, const LfImageStore& store,
                                   LfImageId id, const RectifiedRays& rays, const PixelRect& rect,
                                   double shift_px = 0);

}  // namespace lf
