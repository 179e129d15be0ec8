// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exposure/compare_patches.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "lf/camera/vignetting.h"

namespace lf {
namespace {

constexpr int kHalf = 6;
constexpr int kSide = 2 * kHalf + 1;
constexpr int kPadded = kPatchWindowSide;  // side of the window: the patch and its neighbours
static_assert(kPadded == kSide + 2);
constexpr double kLeastShare = 2. / 3;  // least share of a patch's pixels that must be used
constexpr double kDarkest = 0.01;       // least mean radiance of a channel that is compared
// The three parts of the standard deviation of one pixel's light: relative to the light; absolute,
// in radiance; and relative to the step to the neighbour that differs most.
constexpr double kNoise = 0.005, kDarkNoise = 0.001, kOfStep = 0.15;
constexpr double kLeastDeviation = 5e-4;  // lower bound of a log ratio's standard deviation

PatchWindow WindowOf(const ExposureView& view, const PatchGrid& grid) {
  PatchWindow window;
  for (int y = 0; y < kPadded; ++y)
    for (int x = 0; x < kPadded; ++x)
      window[static_cast<size_t>(y) * kPadded + static_cast<size_t>(x)] = view.LightsAt(
          grid.centre + (x - kHalf - 1) * grid.step_x + (y - kHalf - 1) * grid.step_y);
  return window;
}

float Sum(const std::array<float, 3>& light) { return light[0] + light[1] + light[2]; }

// Returns the largest difference between the light (the sum of R, G and B) of a pixel and of one of
// its four neighbours; NaN if one of the five pixels is not recorded.
float StepAt(const PatchWindow& window, size_t pixel) {
  const float own = Sum(window[pixel]);
  float step = own > 0 ? 0 : std::numeric_limits<float>::quiet_NaN();
  for (const size_t other : {pixel - 1, pixel + 1, pixel - kPadded, pixel + kPadded}) {
    const float light = Sum(window[other]);
    if (light == 0) return std::numeric_limits<float>::quiet_NaN();
    step = std::max(step, std::abs(light - own));
  }
  return step;
}

template <class T>
using PatchPixels = std::array<T, size_t{kSide} * kSide>;

// The pixels of a patch that both LF images recorded. The first `count` entries of every array
// belong to these pixels.
struct Pixels {
  std::array<PatchPixels<float>, 3> a, b;  // light of each channel in LF images a and b
  PatchPixels<float> a_sum, b_sum, a_step, b_step, weight, level;
  PatchPixels<Vec2> a_at, b_at;
  size_t count = 0;
};

void Gather(const PatchWindow& window_a, const PatchWindow& window_b, const PatchGrid& grid_a,
            const PatchGrid& grid_b, Pixels* pixels) {
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const size_t pixel = static_cast<size_t>(y + 1) * kPadded + static_cast<size_t>(x + 1);
      const float step_a = StepAt(window_a, pixel), step_b = StepAt(window_b, pixel);
      if (std::isnan(step_a) || std::isnan(step_b)) continue;
      const size_t i = pixels->count++;
      for (size_t c = 0; c < 3; ++c) {
        pixels->a[c][i] = window_a[pixel][c] - 1;
        pixels->b[c][i] = window_b[pixel][c] - 1;
      }
      pixels->a_sum[i] = Sum(window_a[pixel]) - 3;
      pixels->b_sum[i] = Sum(window_b[pixel]) - 3;
      pixels->a_step[i] = step_a;
      pixels->b_step[i] = step_b;
      pixels->a_at[i] = grid_a.centre + (x - kHalf) * grid_a.step_x + (y - kHalf) * grid_a.step_y;
      pixels->b_at[i] = grid_b.centre + (x - kHalf) * grid_b.step_x + (y - kHalf) * grid_b.step_y;
    }
}

// Sets the level of each pixel, its mean light in both images, and its weight, the inverse variance
// of the light relative to the level. `gain` is the factor that makes image b as bright as
// image a. Multiplied by it, image b has as much influence as a. Because the gain also multiplies
// the noise of b, the geometric mean of both images' noise is used as the absolute noise:
// kDarkNoise sqrt(gain).
//   scale  radiance of one step of ExposureView::light
void Weigh(double gain, double scale, Pixels* pixels) {
  const auto g = static_cast<float>(gain);
  for (size_t i = 0; i < pixels->count; ++i) {
    const float level =
        std::max((pixels->a_sum[i] + g * pixels->b_sum[i]) / 2, static_cast<float>(1e-4 / scale));
    const double step = std::max(pixels->a_step[i], g * pixels->b_step[i]) / level;
    const double dark = 3 * kDarkNoise * std::sqrt(gain) / (scale * level);
    pixels->level[i] = level;
    pixels->weight[i] =
        static_cast<float>(1 / (kNoise * kNoise + dark * dark + kOfStep * kOfStep * step * step));
  }
}

// Weighted sums of the light of the pixels in LF image a and in LF image b.
struct Ratio {
  double a = 0, b = 0;
};
Ratio Sums(const Pixels& pixels, const PatchPixels<float>& a, const PatchPixels<float>& b) {
  Ratio sums;
  for (size_t i = 0; i < pixels.count; ++i) {
    const double weight = pixels.weight[i] / pixels.level[i];
    sums.a += weight * a[i];
    sums.b += weight * b[i];
  }
  return sums;
}

double Deviation(const Pixels& pixels, size_t c, const Ratio& sums) {
  const double gain = sums.a / sums.b;
  double squares = 0;
  for (size_t i = 0; i < pixels.count; ++i) {
    const double weight = pixels.weight[i] / pixels.level[i];
    const double residual = weight * (pixels.a[c][i] - gain * pixels.b[c][i]);
    squares += residual * residual;
  }
  return std::sqrt(squares / (sums.a * sums.a) + kLeastDeviation * kLeastDeviation);
}

// Computes the weighted mean and variance of r^2 (camera/vignetting.h) over the pixels, which are
// at the positions `at` of an LF image.
void TakeRadii(const Intrinsics& k, const PatchPixels<Vec2>& at, const Pixels& pixels, float* mean,
               float* variance) {
  double weights = 0, sum = 0, squares = 0;
  for (size_t i = 0; i < pixels.count; ++i) {
    const double r_squared = RadiusSquared(k, at[i].x(), at[i].y());
    weights += pixels.weight[i];
    sum += pixels.weight[i] * r_squared;
    squares += pixels.weight[i] * r_squared * r_squared;
  }
  *mean = static_cast<float>(sum / weights);
  *variance = static_cast<float>(squares / weights - std::pow(sum / weights, 2));
}

}  // namespace

ComparedPatch::ComparedPatch(const ComparedImage& a, const Place& place, double white)
    : a_(a),
      scale_(white / kLightSteps),
      grid_{place.at_px, Vec2(a.view.grey->divisor, 0), Vec2(0, a.view.grey->divisor)},
      window_(WindowOf(a.view, grid_)) {}

std::optional<ExposureSample> ComparedPatch::CompareWith(const ComparedImage& b,
                                                         const PatchGrid& grid) const {
  Pixels pixels;
  Gather(window_, WindowOf(b.view, grid), grid_, grid, &pixels);
  if (static_cast<double>(pixels.count) < kLeastShare * kSide * kSide) return std::nullopt;
  double a_mean = 0, b_mean = 0;
  for (size_t i = 0; i < pixels.count; ++i) {
    a_mean += pixels.a_sum[i];
    b_mean += pixels.b_sum[i];
  }
  if (a_mean <= 0 || b_mean <= 0) return std::nullopt;
  Weigh(a_mean / b_mean, scale_, &pixels);
  const Ratio all = Sums(pixels, pixels.a_sum, pixels.b_sum);
  Weigh(all.a / all.b, scale_, &pixels);
  ExposureSample sample;
  bool is_any = false;
  for (size_t c = 0; c < 3; ++c) {
    sample.log_ratio[c] = std::numeric_limits<float>::quiet_NaN();
    double a_light = 0, b_light = 0;
    for (size_t i = 0; i < pixels.count; ++i) {
      a_light += pixels.a[c][i];
      b_light += pixels.b[c][i];
    }
    if (scale_ * std::min(a_light, b_light) < kDarkest * static_cast<double>(pixels.count))
      continue;
    const Ratio sums = Sums(pixels, pixels.a[c], pixels.b[c]);
    sample.log_ratio[c] = static_cast<float>(std::log(sums.a / sums.b));
    sample.deviation[c] = static_cast<float>(Deviation(pixels, c, sums));
    is_any = true;
  }
  if (!is_any) return std::nullopt;
  TakeRadii(a_.intrinsics, pixels.a_at, pixels, &sample.a_r_squared, &sample.a_r_variance);
  TakeRadii(b.intrinsics, pixels.b_at, pixels, &sample.b_r_squared, &sample.b_r_variance);
  return sample;
}

}  // namespace lf
