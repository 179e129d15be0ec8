// Gains of LF images and falloffs of their lenses from samples of what two LF images both show:
// robust least squares in the logarithm of light.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "lf/camera/vignetting.h"

namespace lf {

// One place of the scene, as LF images `a` and `b` recorded it.
struct ExposureSample {
  uint32_t a = 0, b = 0;
  // Means of r^2 over what was recorded (camera/vignetting.h).
  float a_r_squared = 0, b_r_squared = 0;
  // ln(light of a / light of b) of R, G and B; NaN: dark or clipped in this channel.
  std::array<float, 3> log_ratio = {};
  float weight = 1;
};

struct FitOptions {
  bool vignetting = false;  // estimate falloffs; else those of `known` are taken
};

struct ExposureFit {
  // ln of the factors that R, G and B of each LF image are multiplied by; 0 on the mean of each
  // component and channel.
  std::vector<std::array<double, 3>> log_gains;
  std::vector<Vignetting> falloffs;  // of each group
  // Component of each LF image: those that samples connect, numbered from 0; kAlone: too few
  // samples agree with those of others.
  std::vector<uint32_t> components;
  uint32_t component_count = 0;
  size_t sample_count = 0;     // that agree with the result, of all channels
  double step = 0;             // mean |ln ratio| that is left of these
  std::vector<float> weights;  // of the samples, in the end: 0 if no channel agrees
};
inline constexpr uint32_t kAlone = UINT32_MAX;

// The model of a sample, with gains g, falloffs F of the groups of a and b:
//
//   ln(a / b) = g_b - g_a + ln F_a(r_a) - ln F_b(r_b)
//
// Samples that do not fit it (hidden by something in front, shining, watermarked) lose their weight
// by Huber's and then Tukey's function of their residual. Falloffs of which the samples tell
// nothing stay 0.
//   groups  of each LF image: which falloff is its own, from 0
//   known   falloffs of the groups
ExposureFit FitExposure(const std::vector<ExposureSample>& samples,
                        const std::vector<uint32_t>& groups, const std::vector<Vignetting>& known,
                        const FitOptions& options);

// ln(a / b) of a channel that the model says of a sample.
double ModelLogRatio(const ExposureSample& sample, int channel,
                     const std::vector<std::array<double, 3>>& log_gains,
                     const std::vector<uint32_t>& groups, const std::vector<Vignetting>& falloffs);

}  // namespace lf
