// SPDX-License-Identifier: Apache-2.0
#include "lf/focus/reduced_image.h"

#include <cmath>
#include <limits>
#include <utility>

namespace lf {
namespace {

// Returns the square root of the mean light of one pixel of the reduced image; NaN if one of the LF
// pixels is masked.
float ReducedPixel(const LfPixels& pixels, int x_begin, int y_begin, int divisor) {
  double sum = 0;
  for (int y = y_begin; y < y_begin + divisor; ++y)
    for (int x = x_begin; x < x_begin + divisor; ++x) {
      if (pixels.IsMasked(x, y)) return std::numeric_limits<float>::quiet_NaN();
      for (int c = 0; c < 3; ++c) sum += pixels.radiance.at(x, y, c);
    }
  return static_cast<float>(std::sqrt(sum / (3 * 65535.0 * divisor * divisor)));
}

}  // namespace

float ReducedImage::At(const Vec2& place_px) const {
  const double x = place_px.x() / divisor - 0.5, y = place_px.y() / divisor - 0.5;
  if (!(x >= 0 && y >= 0 && x < light.width() - 1 && y < light.height() - 1))
    return std::numeric_limits<float>::quiet_NaN();
  const int column = static_cast<int>(x), row = static_cast<int>(y);
  const auto u = static_cast<float>(x - column), v = static_cast<float>(y - row);
  const float* upper = light.row(row) + column;
  const float* lower = light.row(row + 1) + column;
  return (1 - v) * ((1 - u) * upper[0] + u * upper[1]) + v * ((1 - u) * lower[0] + u * lower[1]);
}

int DivisorFor(int width_px) { return (width_px + kMostReducedWidth - 1) / kMostReducedWidth; }

ReducedImage Reduced(const LfPixels& pixels, int divisor) {
  ReducedImage reduced;
  reduced.divisor = divisor;
  const int d = divisor;
  reduced.light = Image<float>(pixels.rect.width() / d, pixels.rect.height() / d, 1);
  for (int y = 0; y < reduced.light.height(); ++y)
    for (int x = 0; x < reduced.light.width(); ++x)
      reduced.light.at(x, y) = ReducedPixel(pixels, x * d, y * d, d);
  return reduced;
}

Result<ReducedImage> LoadReducedImage(const LightField& light_field, const LfImageStore& store,
                                      LfImageId id) {
  const Intrinsics& k = light_field.Camera(id).intrinsics;
  const int divisor = DivisorFor(k.width_px);
  LfPixels pixels;
  LF_ASSIGN_OR_RETURN(const int reduction,
                      LoadReducedWithoutThrowing(store, id, divisor, k,
                                                 light_field.ImagePath(id).string(), &pixels));
  ReducedImage reduced = Reduced(pixels, divisor / reduction);
  reduced.divisor = divisor;
  return reduced;
}

}  // namespace lf
