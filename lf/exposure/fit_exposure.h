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
  // Means of r^2 over what was recorded (camera/vignetting.h), and its variances there.
  float a_r_squared = 0, b_r_squared = 0;
  float a_r_variance = 0, b_r_variance = 0;
  // ln(light of a / light of b) of R, G and B; NaN: dark or clipped in this channel.
  std::array<float, 3> log_ratio = {};
  // Standard deviations of these, up to a factor that all samples share.
  std::array<float, 3> deviation = {0.01f, 0.01f, 0.01f};
};

struct FitOptions {
  bool vignetting = false;  // estimate falloffs; else those of `known` are taken
};

struct ExposureFit {
  // ln of the factors that R, G and B of each LF image are multiplied by; 0 on the mean of each
  // component and channel.
  std::vector<std::array<double, 3>> log_gains;
  std::vector<Vignetting> falloffs;  // of each group
  // Component of each LF image: those that samples connect, numbered from 0; kAlone: samples tell
  // its gain to no better than 2 %, or there are too few that agree.
  std::vector<uint32_t> components;
  uint32_t component_count = 0;
  size_t sample_count = 0;  // that agree with the result, of all channels
  double step = 0;          // mean |ln ratio| that is left of these
  double spread = 0;        // of ln ratio from place to place of two LF images; median over these
  // Of the samples, in the end: the weight of the channel that agrees best, in [0, 1]; 0 if none
  // does.
  std::vector<float> weights;
};
inline constexpr uint32_t kAlone = UINT32_MAX;

// The model of a sample, with gains g, falloffs F of the groups of a and b:
//
//   ln(a / b) = g_b - g_a + ln F_a(r_a) - ln F_b(r_b)
//
// ln F being the mean over what was recorded: that at the mean of r^2, and a term of second order.
// A sample counts by its inverse variance. Samples that do not fit the model (hidden by something
// in front, shining, watermarked) lose their weight by Huber's and then Tukey's function of their
// residual, relative to their deviation. Falloffs of which the samples tell
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
