// SPDX-License-Identifier: Apache-2.0
// Develops the sums and counts of a sensor plate into a picture: average, fill, white balance,
// colour (thesis 4.3.1; doc/ray.md, "Develop").
#pragma once

#include <array>
#include <cstdint>
#include <functional>

#include "lf/core/geometry.h"
#include "lf/core/image.h"
#include "lf/core/parallel.h"
#include "lf/film/develop/picture.h"

namespace lf {

class SensorPlate;  // film/plate/sensor_plate.h

// The part of a frame that was interpolated from kept rays: from rebinned rays
// (render/hybrid/rebinned_rays.h), or from rays on a plate of their own (completion.h).
struct Completion {
  Image<float> rgb;  // [height][width][3], as 16-bit values like those of the plate
  // [height][width] Weight of rgb, in [0, 1], in an element that also has collected rays; the mean
  // of these rays has the weight 1 - share. A channel without collected rays takes rgb alone. Where
  // share is 0, rgb and opacity are unknown and not used.
  Image<float> share;
  // [height][width] as 16-bit values like those of the plate's opacity channel
  // (DevelopOptions::transparent to DevelopOptions::opaque). It is mixed like a colour. The light
  // of rgb, without the pedestal, is multiplied by it, as on the plate. Empty if the light field
  // has no opacities.
  Image<float> opacity = {};
};

// Default and largest value of DevelopOptions::fill_radius_px, in elements. The default is enough
// to fill the elements between the rays of mosaics, or of LF pixels that are larger than elements.
inline constexpr int kFillRadius_px = 2;
inline constexpr int kMostFillRadius_px = 4096;
// An element that is smoothed takes light from collected elements (elements with rays) at most this
// number of elements away.
inline constexpr int kSmoothRadius_px = 32;

struct DevelopOptions {
  double pedestal = 0;  // radiance = (sum of values / number of rays - pedestal) / scale
  double scale = 65535;
  std::array<double, 3> white_balance = {1, 1, 1};
  Mat3 linear_srgb_from_camera = Mat3::Identity();

  // An element with fewer rays than this in a channel, but at least one, is smoothed: averaged with
  // its neighbours. 0 or 1: no element is smoothed.
  uint32_t smooth_below = 0;
  // An element without a ray in a channel takes light from elements that have one, at most this
  // number of elements away. The channel stays black if there are none, because light that was not
  // recorded must not be invented. 0: nothing is filled.
  int fill_radius_px = kFillRadius_px;

  // True: a frame whose plate has no opacities gets an opacity nevertheless, which is 1 where light
  // was recorded, filled or interpolated in some channel, and 0 elsewhere.
  bool adds_opacity = false;
  // For a plate with opacities: opacity = (mean - transparent) / (opaque - transparent), where mean
  // is the sum of values / number of rays of the opacity channel. Likewise for the defocus and the
  // trust of a guarded plate.
  double transparent = 0;
  double opaque = 65535;

  // For a guarded plate: the effective number of recorded LF images of each element (picture.h). If
  // given, elements that show several of them take all rays whatever their trust.
  const Image<float>* effective_count = nullptr;

  // Light interpolated from kept rays. If given, it is mixed with collected light, and used alone
  // in elements without rays. Its images must have the size of the plate, and it must have
  // opacities if the plate has them, otherwise none.
  const Completion* completion = nullptr;

  // If given, any thread calls it, before each row and at least once for every 64 values (channels
  // of elements) that are filled. Once it returns true, the remaining work is skipped, and the
  // result must not be used.
  std::function<bool()> is_interrupted = {};
};

// An element of a guarded plate shows the rays of recorded LF images alone up to kGuardFrom, and
// those of all LF images from kGuardTo on; in part between. The two numbers are shares of its
// recorded rays that are out of focus.
inline constexpr double kGuardFrom = 0.1;
inline constexpr double kGuardTo = 0.2;
// It shows the rays of all LF images only where their trust is above kTrustFrom, without loss from
// kTrustTo on, if the recorded rays are those of a single LF image: this is sharp, and right from
// one place. The copies that several LF images show are farther from the truth than rays of low
// trust are.
inline constexpr double kTrustFrom = 0.3;
inline constexpr double kTrustTo = 0.45;
// An element is doubtful if its trust is below kDoubtfulTrust: more than a fifth of such elements
// are visibly wrong (render/collect/opacity_and_trust.h).
inline constexpr double kDoubtfulTrust = 0.8;

// Averages the rays of every element and channel, and mixes the average A with the completion I:
// (1 - share) A + share I. The completion is taken alone if no ray was collected. A frame whose
// completion is its average is therefore the frame without completion. An element without
// completion that has no ray, or fewer than smooth_below, takes the inverse-distance mean of
// collected elements of the channel,
//
//   (sum_i v_i / d_i) / (sum_i 1 / d_i)                                       (Shepard 1968)
//
// where v_i is the average of collected element i and d_i the distance of its centre, in elements,
// over all collected elements within the smallest radius in which there are at least 4 of them,
// with at least smooth_below rays together. The radius is at most fill_radius_px for an element
// without a ray, and kSmoothRadius_px otherwise, even if it contains fewer. The element's own
// value, if it has one, is one of the v_i, with d = 0.5. Elements with completion count as
// collected, with enough rays. Then Develop() applies white balance and linear_srgb_from_camera.
// The average A of a guarded plate is R + m t (V - R), where R is the average of the recorded rays,
// V that of all rays, m grows from 0 to 1 like s^2 (3 - 2 s) where s is the share of defocus from
// kGuardFrom to kGuardTo, and t = 1 - p (1 - S), where S grows likewise where s is the trust from
// kTrustFrom to kTrustTo, and p falls from 1 to 0 where the effective number of recorded LF images
// grows from 1 to 2; p = 1 if the number is not known. Without recorded rays it is V, whatever the
// trust. The opacity has the same formula. DevelopedFrame::densified, trust and doubtful_count
// describe A, whatever the share of the completion.
// Opacities are averaged, mixed and filled like a colour, from the same neighbours, and clipped.
// Each colour is the light times the opacity, so that means and mixtures of both belong together.
// Counts above 2^32 - 1 become 2^32 - 1. The bits do not depend on the number of threads.
DevelopedFrame Develop(const SensorPlate& plate, const DevelopOptions& options, ThreadPool& pool);

}  // namespace lf
