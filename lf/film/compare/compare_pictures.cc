// SPDX-License-Identifier: Apache-2.0
#include "lf/film/compare/compare_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "lf/film/compare/ssim.h"
#include "lf/film/develop/display.h"

namespace lf {
namespace {

double PsnrOf(double squares, int64_t pixel_count) {
  return -10 * std::log10(squares / (3 * static_cast<double>(pixel_count)));
}

bool IsDefined(const Image<float>& rgb, int x, int y) {
  return std::isfinite(rgb.at(x, y, 0)) && std::isfinite(rgb.at(x, y, 1)) &&
         std::isfinite(rgb.at(x, y, 2));
}

// A picture that is clipped to what a display shows.
struct Shown {
  Image<float> light;       // linear, in [0, 1]; 0 where a value is undefined
  Image<float> display;     // sRGB values of `light`
  Image<float> brightness;  // one channel
};

Shown Show(const Image<float>& rgb, ThreadPool& pool) {
  const int width = rgb.width(), height = rgb.height();
  Shown shown{Image<float>(width, height, 3), Image<float>(width, height, 3),
              Image<float>(width, height)};
  pool.ForEach(height, [&](size_t row) {
    const int y = static_cast<int>(row);
    constexpr double kWeights[3] = {0.2126, 0.7152, 0.0722};
    for (int x = 0; x < width; ++x) {
      double brightness = 0;
      for (int c = 0; c < 3; ++c) {
        const float value = rgb.at(x, y, c);
        const float light = std::isfinite(value) ? std::clamp(value, 0.0f, 1.0f) : 0;
        const double display = DisplayFromLinear(light);
        shown.light.at(x, y, c) = light;
        shown.display.at(x, y, c) = static_cast<float>(display);
        brightness += kWeights[c] * display;
      }
      shown.brightness.at(x, y) = static_cast<float>(brightness);
    }
  });
  return shown;
}

bool IsCovered(const PictureLight& picture, int x, int y, double min_coverage) {
  return !picture.coverage || picture.coverage->at(x, y) >= min_coverage;
}

}  // namespace

PictureDifference& PictureDifference::operator+=(const PictureDifference& other) {
  pixel_count += other.pixel_count;
  undefined_count += other.undefined_count;
  linear_squares += other.linear_squares;
  display_squares += other.display_squares;
  ssim_sum += other.ssim_sum;
  flip_sum += other.flip_sum;
  return *this;
}

double PictureDifference::PsnrDb() const { return PsnrOf(display_squares, pixel_count); }
double PictureDifference::LinearPsnrDb() const { return PsnrOf(linear_squares, pixel_count); }

Result<PictureComparison> ComparePictures(const PictureLight& reference, const PictureLight& test,
                                          const CompareOptions& options, ThreadPool& pool) {
  const Image<float>&a = reference.rgb, &b = test.rgb;
  if (a.width() != b.width() || a.height() != b.height())
    return InputError(fmt::format("has {} x {} pixels, expected {} x {} as the reference",
                                  b.width(), b.height(), a.width(), a.height()));
  const Shown shown_a = Show(a, pool), shown_b = Show(b, pool);
  const Image<float> similarity =
      StructuralSimilarity(shown_a.brightness, shown_b.brightness, pool);
  PictureComparison comparison;
  comparison.flip = FlipErrors(shown_a.light, shown_b.light, options.pixels_per_degree, pool);

  // One sum for each row, so that the order of additions does not depend on threads.
  std::vector<PictureDifference> rows(a.height());
  pool.ForEach(a.height(), [&](size_t row) {
    const int y = static_cast<int>(row);
    if (y < options.border || y >= a.height() - options.border) return;
    PictureDifference& sum = rows[row];
    for (int x = options.border; x < a.width() - options.border; ++x) {
      if (!IsCovered(reference, x, y, options.min_coverage) ||
          !IsCovered(test, x, y, options.min_coverage))
        continue;
      if (!IsDefined(a, x, y) || !IsDefined(b, x, y)) {
        ++sum.undefined_count;
        continue;
      }
      ++sum.pixel_count;
      for (int c = 0; c < 3; ++c) {
        const double linear = static_cast<double>(b.at(x, y, c)) - a.at(x, y, c);
        const double display =
            static_cast<double>(shown_b.display.at(x, y, c)) - shown_a.display.at(x, y, c);
        sum.linear_squares += linear * linear;
        sum.display_squares += display * display;
      }
      sum.ssim_sum += similarity.at(x, y);
      sum.flip_sum += comparison.flip.at(x, y);
    }
  });
  for (const PictureDifference& row : rows) comparison.difference += row;
  if (comparison.difference.pixel_count == 0)
    return InputError(fmt::format(
        "no pixel can be compared: {} of {} x {} pixels are undefined, and the others lie within "
        "the border of {} pixels or have a coverage below {}",
        comparison.difference.undefined_count, a.width(), a.height(), options.border,
        options.min_coverage));
  return comparison;
}

}  // namespace lf
