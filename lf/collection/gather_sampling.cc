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

PixelFilter FilterOf(PixelFilter filter, const RadianceEncoding& encoding, bool counts_rays) {
  if (filter != PixelFilter::kAuto) return filter;
  if (encoding.bayer != BayerPattern::kNone && !counts_rays) return PixelFilter::kMosaic;
  return encoding.masks_clipped ? PixelFilter::kBicubic : PixelFilter::kPrefiltered;
}

GatherSampling SamplingOf(const PinholeCamera& lf_camera, const RenderCamera& render_camera,
                          const PixelReading& reading) {
  const double width_px = ElementWidth_px(lf_camera, render_camera);
  GatherSampling sampling;
  sampling.filter = FilterOf(reading.filter, RadianceEncoding(), false);
  const PixelFootprint footprint = reading.footprint.value_or(PixelFootprint::kArea);
  const bool may_lack_rays = MayLackRays(lf_camera.intrinsics);
  const bool corrects = sampling.filter == PixelFilter::kMosaic;
  if (corrects) sampling.filter = PixelFilter::kPrefiltered;
  const bool is_mosaic = false;
  const bool are_finer = width_px > kFinerAtMost;
  const bool by_shares = is_mosaic && width_px >= kMosaicByShares;
  const bool prefilters = sampling.filter == PixelFilter::kPrefiltered || by_shares ||
                          (is_mosaic && !are_finer && footprint == PixelFootprint::kArea);
  // A prefilter would mix pixels that have no ray into those that have one.
  if (prefilters && !may_lack_rays) {
    sampling.step_px = static_cast<int>(std::clamp(std::round(width_px), 1.0, kWidestElement_px));
    sampling.is_cubic = by_shares && width_px < kMosaicOfFour;
    sampling.prefilter = sampling.is_cubic ? MeanOfMosaic(width_px, footprint)
                         : by_shares       ? PrefilterOfMosaic(width_px, footprint)
                                           : PrefilterFor(width_px, footprint);
    if (corrects) sampling.prefilter.correction = reading.correction;
    return sampling;
  }
  if (sampling.filter == PixelFilter::kPrefiltered) sampling.filter = PixelFilter::kBilinear;
  // A value just above a whole number counts as that number.
  constexpr double kRounding = 1e-3;
  if (are_finer)
    sampling.samples =
        static_cast<int>(std::ceil(std::min<double>(width_px - kRounding, kMostSamples)));
  sampling.is_cubic = sampling.filter == PixelFilter::kBicubic ||
                      (sampling.filter == PixelFilter::kMosaic && sampling.samples < kBilinearFrom);
  if (sampling.is_cubic && may_lack_rays) {
    sampling.is_cubic = false;
    if (sampling.filter == PixelFilter::kBicubic) sampling.filter = PixelFilter::kBilinear;
  }
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
