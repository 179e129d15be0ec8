// SPDX-License-Identifier: Apache-2.0
// Fits gains of LF images and falloffs of their lenses to samples: places of the scene that two LF
// images show. The fit is a robust least squares fit of the logarithm of light.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "lf/camera/vignetting.h"

namespace lf {

// One place of the scene, as the LF images with the ids `a` and `b` recorded it.
struct ExposureSample {
  uint32_t a = 0, b = 0;
  // Mean and variance of r^2 over the compared pixels in each LF image. r is the distance from the
  // principal point, relative to half of the image's diagonal (camera/vignetting.h).
  float a_r_squared = 0, b_r_squared = 0;
  float a_r_variance = 0, b_r_variance = 0;
  // ln(light of a / light of b) in R, G and B; NaN if a channel is dark or clipped.
  std::array<float, 3> log_ratio = {};
  // Standard deviations of log_ratio, up to a factor that is the same for all samples.
  std::array<float, 3> deviation = {0.01f, 0.01f, 0.01f};
};

struct FitOptions {
  bool vignetting = false;  // true: falloffs are estimated; false: they are given to FitExposure()
};

struct ExposureFit {
  // ln of the gains of R, G and B of each LF image. In each component and channel, their mean is 0;
  // 0 for an LF image that is kAlone.
  std::vector<std::array<double, 3>> log_gains;
  std::vector<Vignetting> falloffs;  // falloff of each group of LF images that share one
  // Component of each LF image, numbered from 0: LF images that are connected by samples have the
  // same number. kAlone: the standard deviation of the image's gain is above 2 %, too few samples
  // agree, or no other LF image is connected to the image.
  std::vector<uint32_t> components;
  uint32_t component_count = 0;
  size_t sample_count = 0;  // number of log ratios of samples that agree with the fitted model
  double step = 0;          // mean of |ln(a / b) - model| (FitExposure()) over these log ratios
  // The residuals ln(a / b) - model of a pair of LF images have a robust standard deviation over
  // the pair's samples. This is the median of that deviation over all pairs.
  double spread = 0;
  // Final robust weight of each sample, in [0, 1]: the weight of the channel that agrees best; 0 if
  // no channel agrees, or if the images are kAlone.
  std::vector<float> weights;
};
inline constexpr uint32_t kAlone = UINT32_MAX;

// Fits a model to the samples. It predicts the ratio of the light that LF images a and b record of
// a place, from their log gains g and the falloffs F of their groups at the place's distances r
// from the principal points:
//
//   ln(a / b) = g_b - g_a + ln F_a(r_a) - ln F_b(r_b)
//
// ln F(r) is averaged over the compared pixels: its value at the mean of r^2, plus a term of second
// order. The weight of a sample is its inverse variance. Samples that do not fit the model (of
// places that are hidden by something in front, shine or are watermarked) lose weight by Huber's
// and then Tukey's function of their residual, relative to their deviation. Coefficients of
// falloffs that no sample determines stay 0.
//   groups  for each LF image, the number of its falloff, from 0
//   known   falloffs of the groups, which are used if options.vignetting is false
ExposureFit FitExposure(const std::vector<ExposureSample>& samples,
                        const std::vector<uint32_t>& groups, const std::vector<Vignetting>& known,
                        const FitOptions& options);

// Returns ln(a / b) of a sample in a channel as the model of FitExposure() predicts it.
double ModelLogRatio(const ExposureSample& sample, int channel,
                     const std::vector<std::array<double, 3>>& log_gains,
                     const std::vector<uint32_t>& groups, const std::vector<Vignetting>& falloffs);

}  // namespace lf
