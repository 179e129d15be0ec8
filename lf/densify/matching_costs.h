// SPDX-License-Identifier: Apache-2.0
// Compares an LF image with its neighbours at a sequence of inverse depths (plane sweep).
#pragma once

#include <cstdint>
#include <span>

#include "lf/core/geometry.h"
#include "lf/core/large_vector.h"
#include "lf/densify/inverse_depths.h"
#include "lf/densify/pair_map.h"
#include "lf/densify/watched_loop.h"
#include "lf/densify/working_image.h"

namespace lf {

// An LF image that a reference image is compared with.
struct SweepView {
  const WorkingImage* image = nullptr;
  PairMap from_reference;
  Vec2 direction = Vec2::Zero();  // towards its LF camera, along x and y of the reference camera
};
// `image` must outlive the result.
SweepView ViewFrom(const WorkingImage& reference, const WorkingImage& image);

// Costs of a rectangle of pixels at a sequence of inverse depths.
struct MatchingCosts {
  // Largest cost: the mean of 3 x 3 differences of ComparedTones(), each the sum over R, G and B
  // and limited to kMostDifference, in steps of 1 / kPerTone.
  static constexpr int kMostDifference = 80, kPerTone = 3;
  static constexpr int kMost = kPerTone * kMostDifference;
  // Cost of an inverse depth at which a pixel cannot be, because another LF image sees nothing
  // there.
  static constexpr int kCarved = 255;
  // Number of costs of a pixel in memory: `planes`, rounded up; costs beyond `planes` are kMost.
  static constexpr int kPadding = 32;

  PixelRect rect;
  int planes = 0;  // number of costs of a pixel: entries of a PlaneSet
  int stride = 0;
  LargeVector<uint8_t> costs;  // [height][width][stride]

  static int StrideOf(int planes) { return (planes + kPadding - 1) / kPadding * kPadding; }
  const uint8_t* At(int column, int row) const {
    return costs.data() + (static_cast<size_t>(row) * rect.width() + column) * stride;
  }
};

// Computes the costs of the pixels `rect` of the reference image. The cost of a pixel at an inverse
// depth is the least of the mean costs over several groups of views: all views, and the views on
// one side of the reference camera, for eight sides. A pixel that is hidden from the views on one
// side, because it lies beside the outline of a nearer object, is seen by those on the other (Kang,
// Szeliski and Chai, "Handling occlusions in dense multi-view stereo", CVPR 2001). No side explains
// a view that is transparent there (WorkingImage::empty): the cost is then kCarved, unless the
// pixel is transparent.
//   views        one or more
//   depths       two or more; NaN: no depth is compared there, and costs are kCarved
//   interrupted  once it is set, the result must not be used
void ComputeMatchingCosts(const WorkingImage& reference, std::span<const SweepView> views,
                          std::span<const float> depths, const PixelRect& rect,
                          MatchingCosts* result, InterruptFlag interrupted = nullptr);
// As above, at `planes` inverse depths, evenly spaced over a range.
void ComputeMatchingCosts(const WorkingImage& reference, std::span<const SweepView> views,
                          const InverseDepths& range, int planes, const PixelRect& rect,
                          MatchingCosts* result, InterruptFlag interrupted = nullptr);

}  // namespace lf
