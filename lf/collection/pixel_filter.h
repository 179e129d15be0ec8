// SPDX-License-Identifier: Apache-2.0
// The filters by which the estimator *bilinear* reads the pixels of LF images (doc/ray.md, "What is
// added").
#pragma once

#include <optional>

#include "lf/light_field/model/radiance.h"

namespace lf {

// Filters that compute the value of a ray from the LF pixels around it:
//   kNearest   takes the value of the nearest pixel
//   kBilinear  interpolates linearly between four pixels
//   kBicubic   interpolates between sixteen pixels by Catmull and Rom's cubics. This restores some
//              of the sharpness that is lost because a camera averages over each pixel, and takes
//              three times as long as kBilinear. If one of the outer twelve pixels is outside the
//              image or masked, the ray is bilinear
//   kPrefiltered  interpolates linearly between four values of an LF image that was filtered before
//              (prefilter.h), so that an element of any size needs only one sample. Images that may
//              lack rays (MayLackRays()) are not filtered: the ray is bilinear
//   kMosaic    is for RGB pixels made from a mosaic. Does the same as kPrefiltered, after a
//              correction of the pixels (Prefilter::correction)
//   kAuto      stands for the filter that FilterOf() returns for the whole light field;
//              SamplingOf() takes it as kPrefiltered
enum class PixelFilter { kAuto, kNearest, kBilinear, kBicubic, kMosaic, kPrefiltered };

// Returns "auto", "nearest", "bilinear", "bicubic", "mosaic" or "prefiltered".
const char* NameOf(PixelFilter filter);

// A filter, and what it needs to know of LF pixels.
struct PixelReading {
  PixelFilter filter = PixelFilter::kAuto;
  std::optional<PixelFootprint> footprint = std::nullopt;  // used by prefilters; unset: kArea
  int correction = 0;                                      // Prefilter::correction, used by kMosaic

  PixelReading() = default;
  PixelReading(PixelFilter the_filter)
      : filter(the_filter) {}  // NOLINT: implicit, because `footprint` has a default
};

}  // namespace lf
