// From sums and counts to a picture: average, fill, white balance, colour (thesis 4.3.1;
// doc/ray.md, "Develop").
#pragma once

#include <array>
#include <cstdint>
#include <functional>

#include "lf/core/geometry.h"
#include "lf/core/image.h"
#include "lf/core/parallel.h"
#include "lf/plate/sensor_plate.h"

namespace lf {

// What was interpolated of a frame from rebinned rays (hybrid/rebinned_rays.h).
struct Completion {
  Image<float> rgb;  // [height][width][3], as averages of the plate's rays
  Image<float>
      share;  // [height][width] of it in an element that has rays, too; 0: nothing is known
};

// Closes the gaps between the rays of mosaics and of LF pixels that are larger than elements.
inline constexpr int kFillRadius_px = 2;
inline constexpr int kMostFillRadius_px = 4096;
// Elements that are smoothed take light from collected ones at most this far away.
inline constexpr int kSmoothRadius_px = 32;

struct DevelopOptions {
  double pedestal = 0;  // radiance = (sum / count - pedestal) / scale
  double scale = 65535;
  std::array<double, 3> white_balance = {1, 1, 1};
  Mat3 camera_to_srgb = Mat3::Identity();

  // Elements with fewer rays than this in a channel, but with some, are smoothed. 0 and 1: none.
  uint32_t smooth_below = 0;
  // A channel without a ray takes light from collected elements at most this far away, and stays
  // black if there is none: light that nobody recorded is not invented. 0: nothing is filled.
  int fill_radius_px = kFillRadius_px;

  // For a plate with opacities: opacity = (sum / count - transparent) / (opaque - transparent).
  double transparent = 0;
  double opaque = 65535;

  // Mixed with what was collected, if given; stands for what was not. Not of a plate with
  // opacities.
  const Completion* completion = nullptr;

  // Asked by any thread, at least before each row and every 64 elements to be filled, if given.
  // Once it is true, the rest is left out and the answer is of no use.
  std::function<bool()> is_interrupted = {};
};

struct DevelopedFrame {
  Image<float> rgb;           // [height][width][3] linear light, sRGB primaries
  Image<uint32_t> ray_count;  // [height][width][3]
  Image<float> coverage;      // [height][width] share of the channels with a ray of their own
  // [height][width] of a plate with opacities, in [0, 1]: rgb is multiplied with it; else empty
  Image<float> opacity = {};
  // [height][width] with lens weights, where counts are sums of weights: how many LF images of
  // equal weight would make as little noise; else empty
  Image<float> effective_count = {};
  // [height][width] with completion: the part of each element that was interpolated; else empty
  Image<float> interpolated = {};
};

// Averages every element and channel: (1 - share) of it and share of the completion, or that alone
// where no ray was collected. Those without either (or with fewer rays than smooth_below) take
// the inverse-distance mean of collected elements of the channel,
//
//   sum_i v_i / d_i  /  sum_i 1 / d_i      (Shepard 1968; d between element centres, in elements)
//
// over all that lie within the smallest radius that holds at least 4 of them and at least
// smooth_below rays, but never beyond fill_radius_px (of those without a ray) or kSmoothRadius_px,
// where fewer must do. Their own value, if they have one, is among them at d = 0.5. Then white
// balance and camera_to_srgb. Opacities are averaged and filled like a colour, by the same
// neighbours, and clipped. Counts above 2^32 - 1 are given as that. The same bits for any thread
// count.
DevelopedFrame Develop(const SensorPlate& plate, const DevelopOptions& options, ThreadPool& pool);

}  // namespace lf
