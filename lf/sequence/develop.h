// From sums and counts to a picture: average, fill, white balance, colour (thesis 4.3.1; RAY.md,
// "Develop").
#pragma once

#include <array>
#include <cstdint>

#include "lf/core/geometry.h"
#include "lf/core/image.h"
#include "lf/core/parallel.h"
#include "lf/plate/sensor_plate.h"

namespace lf {

struct DevelopOptions {
  double pedestal = 0;  // radiance = (sum / count - pedestal) / scale
  double scale = 65535;
  std::array<double, 3> white_balance = {1, 1, 1};
  Mat3 camera_to_srgb = Mat3::Identity();

  // Elements with fewer rays than this in a channel are smoothed; 0 and 1: only empty ones are
  // filled.
  uint32_t smooth_below = 0;
  // Elements further than this from any collected one stay black: light that nobody recorded is
  // not invented.
  int fill_radius_px = 32;
};

struct DevelopedFrame {
  Image<float> rgb;           // [height][width][3] linear light, sRGB primaries
  Image<uint32_t> ray_count;  // [height][width][3]
  Image<float> coverage;      // [height][width] share of the channels with a ray of their own
};

// Averages every element and channel. Those without a ray (or with fewer than smooth_below) take
// the inverse-distance mean (1/d, Shepard; thesis [She68]) of collected elements of the channel
// within the smallest radius that holds at least 4 of them and at least smooth_below rays; their
// own value enters at d = 0.5. The same bits for any thread count.
DevelopedFrame Develop(const SensorPlate& plate, const DevelopOptions& options, ThreadPool& pool);

}  // namespace lf
