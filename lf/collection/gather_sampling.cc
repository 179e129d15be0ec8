// SPDX-License-Identifier: Apache-2.0
#include "lf/collection/gather_sampling.h"

#include <algorithm>
#include <cmath>

#include "lf/camera/distortion.h"
#include "lf/camera/ideal_pixels.h"
#include "lf/camera/magnification.h"
#include "lf/camera/resolution.h"

namespace lf {
const char* NameOf(PixelFilter filter) {
  constexpr const char* kNames[] = {"auto",    "nearest", "bilinear",
                                    "bicubic", "mosaic",  "prefiltered"};
  return kNames[static_cast<int>(filter)];
}

PixelFilter FilterOf(PixelFilter filter, const RadianceEncoding& encoding) {
  if (filter != PixelFilter::kAuto) return filter;
  if (encoding.bayer != BayerPattern::kNone) return PixelFilter::kMosaic;
  return encoding.masks_clipped ? PixelFilter::kBicubic : PixelFilter::kPrefiltered;
}

GatherSampling SamplingOf(const PinholeCamera& lf_camera, const RenderCamera& render_camera,
                          const PixelReading& reading) {
  const double width_px = ElementWidth_px(lf_camera, render_camera);
  GatherSampling sampling;
  sampling.filter = FilterOf(reading.filter, RadianceEncoding());
  const bool is_mosaic = sampling.filter == PixelFilter::kMosaic;
  if (is_mosaic) sampling.filter = PixelFilter::kPrefiltered;
  const bool may_lack_rays = MayLackRays(lf_camera.intrinsics);
  const bool prefilters = sampling.filter == PixelFilter::kPrefiltered && !may_lack_rays;
  if (prefilters) {
    sampling.step_px = static_cast<int>(std::clamp(std::round(width_px), 1.0, kWidestElement_px));
    sampling.prefilter = PrefilterFor(width_px, reading.footprint.value_or(PixelFootprint::kArea));
  }
  if (is_mosaic) sampling.prefilter.correction = reading.correction;
  if (prefilters) return sampling;
  // Prefilters and cubics would mix pixels that have no ray into those that have one.
  if (may_lack_rays && sampling.filter != PixelFilter::kNearest)
    sampling.filter = PixelFilter::kBilinear;
  // A value just above a whole number counts as that number.
  constexpr double kRounding = 1e-3;
  if (width_px > kFinerAtMost)
    sampling.samples =
        static_cast<int>(std::ceil(std::min<double>(width_px - kRounding, kMostSamples)));
  sampling.is_cubic = sampling.filter == PixelFilter::kBicubic;
  return sampling;
}

bool MayLackRays(const Intrinsics& k) {
  if (!k.has_distortion()) return false;
  const DistortionMap map(k.distortion);
  // The corner pixels, which are farthest from the optical axis, lose their rays first.
  for (const double x : {0.5, k.width_px - 0.5})
    for (const double y : {0.5, k.height_px - 0.5})
      if (!IdealPosition(k, map, x, y)) return true;
  return false;
}

RenderCamera WithFinerPlate(const RenderCamera& render_camera, int samples) {
  RenderCamera finer = render_camera;
  Intrinsics& k = finer.pinhole.intrinsics;
  ScaleResolution(samples, &k);
  k.width_px *= samples;
  k.height_px *= samples;
  if (finer.window)
    for (int* const border : {&finer.window->x_begin, &finer.window->y_begin, &finer.window->x_end,
                              &finer.window->y_end})
      *border *= samples;
  return finer;
}

}  // namespace lf
