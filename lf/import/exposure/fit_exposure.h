// Fits gains of LF images and falloffs of their lenses to samples of places that two LF images
// show: robust least squares in the logarithm of light.
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
  // Means of r^2 over the compared pixels (camera/vignetting.h), and variances of r^2.
  float a_r_squared = 0, b_r_squared = 0;
  float a_r_variance = 0, b_r_variance = 0;
  // ln(light of a / light of b) in R, G and B; NaN: dark or clipped in this channel.
  std::array<float, 3> log_ratio = {};
  // Standard deviations of log_ratio, up to a factor that all samples share.
  std::array<float, 3> deviation = {0.01f, 0.01f, 0.01f};
};

struct FitOptions {
  bool vignetting = false;  // if true, falloffs are estimated; if false, those of `known` are used
};

struct ExposureFit {
  // ln of the factors that R, G and B of each LF image are multiplied by. The mean of each
  // component and channel is 0.
  std::vector<std::array<double, 3>> log_gains;
  std::vector<Vignetting> falloffs;  // of each group
  // Component of each LF image, numbered from 0: LF images that samples connect have the same.
  // kAlone: the deviation of the image's gain is above 2 %, or too few samples agree.
  std::vector<uint32_t> components;
  uint32_t component_count = 0;
  size_t sample_count = 0;  // number of samples, over all channels, that agree with the result
  double step = 0;          // mean |ln ratio| that remains of these
  double spread = 0;  // of ln ratio between the places of two LF images; median over all pairs
  // Final weight of each sample: that of the channel that agrees best, in [0, 1]; 0 if none agrees.
  std::vector<float> weights;
};
inline constexpr uint32_t kAlone = UINT32_MAX;

// Fits the model of a sample, with log gains g and the falloffs F of the groups of a and b:
//
//   ln(a / b) = g_b - g_a + ln F_a(r_a) - ln F_b(r_b)
//
// Here ln F is its mean over the compared pixels: its value at the mean of r^2, and a term of
// second order. The weight of a sample is its inverse variance. Samples that do not fit the model
// (hidden by something in front, shining, watermarked) lose their weight by Huber's and then
// Tukey's function of their residual, relative to their deviation. Falloffs of which the samples
// tell nothing stay 0.
//   groups  number of the falloff of each LF image, from 0
//   known   falloffs of the groups
ExposureFit FitExposure(const std::vector<ExposureSample>& samples,
                        const std::vector<uint32_t>& groups, const std::vector<Vignetting>& known,
                        const FitOptions& options);

// Returns ln(a / b) of a sample in a channel by the model.
double ModelLogRatio(const ExposureSample& sample, int channel,
                     const std::vector<std::array<double, 3>>& log_gains,
                     const std::vector<uint32_t>& groups, const std::vector<Vignetting>& falloffs);

}  // namespace lf
