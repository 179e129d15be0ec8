// SPDX-License-Identifier: Apache-2.0
// Decides how the estimator *bilinear* samples an LF image for an element (doc/ray.md, "What is
// added"): with which filter, and at how many positions.
#pragma once

#include <optional>

#include "lf/camera/pinhole.h"
#include "lf/camera/render_camera.h"
#include "lf/collection/pixel_filter.h"
#include "lf/collection/prefilter/prefilter.h"

namespace lf {

// Returns the filter that `filter` stands for, which is never kAuto. kAuto is
//   kMosaic      for mosaics
//   kBicubic     for brackets, because each of their LF images has the pixels of only some regions,
//                at whose borders a prefilter lacks pixels
//   kPrefiltered otherwise
PixelFilter FilterOf(PixelFilter filter, const RadianceEncoding& encoding);

// Largest number of samples along an edge of an element.
inline constexpr int kMostSamples = static_cast<int>(kWidestElement_px);

// True if some pixels of the image have no ray because they lie beyond the fold of the lens
// distortion. Such an image is neither prefiltered nor interpolated between sixteen pixels.
bool MayLackRays(const Intrinsics& k);

// How the elements of one frame sample one LF image.
struct GatherSampling {
  PixelFilter filter = PixelFilter::kBilinear;  // never kAuto, nor kMosaic
  bool is_cubic = false;  // true: interpolates between sixteen pixels where possible
  // Number of samples along each edge of an element: the number of LF pixels along an edge, rounded
  // up, at most kMostSamples; 1 if there are at most kFinerAtMost LF pixels along an edge, or if
  // the filter is kPrefiltered. The element's ray is the mean of samples^2 evenly spaced rays, or
  // of as many of these as exist.
  int samples = 1;
  int step_px = 1;  // about the distance of the rays of neighbouring elements in the LF image
  // The filter that must be applied to the LF image before it is sampled.
  Prefilter prefilter = {};
};
GatherSampling SamplingOf(const PinholeCamera& lf_camera, const RenderCamera& render_camera,
                          const PixelReading& reading);

// Returns the render camera with a plate that has `samples` times as many rows and columns of
// elements for the same picture.
RenderCamera WithFinerPlate(const RenderCamera& render_camera, int samples);

}  // namespace lf
