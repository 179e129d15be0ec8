// SPDX-License-Identifier: Apache-2.0
// Says how rays are made from the pixels of LF images (doc/ray.md, "What is added").
#pragma once

#include "lf/collection/pixel_filter.h"

namespace lf {

enum class PixelReach;  // selection/overlap.h

// How rays are found. kNearest: the ray of every LF pixel is added to the element that it hits.
// kBilinear: every element samples each LF image at the position that it sees there. For kBilinear,
// the LF images must be RGB.
enum class Estimator { kNearest, kBilinear };

// Returns "nearest" or "bilinear".
const char* NameOf(Estimator estimator);

struct RayReading : PixelReading {  // its member `filter` is used only by kBilinear
  Estimator estimator = Estimator::kNearest;

  RayReading() = default;
  RayReading(Estimator the_estimator) : estimator(the_estimator) {}  // NOLINT: implicit on purpose

  // Returns true if LF images may be filtered (Prefilter) before rays are read from them.
  bool Prefilters() const {
    return estimator == Estimator::kBilinear &&
           (filter == PixelFilter::kPrefiltered || filter == PixelFilter::kMosaic ||
            filter == PixelFilter::kAuto);
  }
};

// Returns which pixels of an LF image decide the value of one ray: the pixel of the ray itself, its
// neighbours, or the pixels that a prefilter or the correction before it reads. Selection must use
// this as SelectOptions::reach.
PixelReach ReachOf(const RayReading& reading);

// Returns the largest ReachOf() that any filter has, for LF images of this encoding. Selections
// that do not know the filter use it.
PixelReach WidestReachOf(Estimator estimator, const RadianceEncoding& encoding);

// kReference applies the ray model literally to every pixel, on one thread. It is about 50 times
// slower than kFast; tests compare kFast with it.
enum class CollectBackEnd { kFast, kReference };

}  // namespace lf
