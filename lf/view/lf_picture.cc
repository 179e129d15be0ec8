// SPDX-License-Identifier: Apache-2.0
#include "lf/view/lf_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "lf/light_field/model/radiance.h"

namespace lf {
namespace {

constexpr uint8_t kMaskedGrey = 128;
// Number of steps of linear light from 0 to 1. Near black, a step is 0.4 of a display value (0 to
// 255).
constexpr int kSteps = 8192;

uint8_t DisplayValue(double linear) {
  static const std::vector<uint8_t> values = [] {
    std::vector<uint8_t> table(kSteps + 1);
    for (int i = 0; i <= kSteps; ++i)
      table[i] =
          static_cast<uint8_t>(std::lround(255 * SrgbFromLinear(static_cast<double>(i) / kSteps)));
    return table;
  }();
  return values[static_cast<size_t>(std::clamp(linear, 0.0, 1.0) * kSteps + 0.5)];
}

// Returns the side of the squares of LF pixels that are one pixel of a picture: the smallest one
// with which the picture is not too large, and that LF images can be loaded reduced by, except
// for 3.
int SquareSide(const Intrinsics& k, int max_side_px) {
  const int largest_px = std::max(k.width_px, k.height_px), most_px = std::max(1, max_side_px);
  const int least = std::max(1, (largest_px + most_px - 1) / most_px);
  for (const int side : {1, 2, 3, 4, 6, 8, 12})
    if (least <= side) return side;
  return (least + 7) / 8 * 8;
}

// Returns sums over the unmasked pixels of a square: R, G, B, and the number of these pixels.
std::array<double, 4> SumOf(const LfPixels& pixels, const PixelRect& square) {
  std::array<double, 4> sum = {};
  for (int y = square.y_begin; y < square.y_end; ++y)
    for (int x = square.x_begin; x < square.x_end; ++x)
      for (int lane = 0; lane < LfPixels::kRgbLanes; ++lane)
        sum[lane] += pixels.radiance.at(x, y, lane);
  return sum;
}

}  // namespace

std::array<uint8_t, 3> DisplayColour(const RadianceEncoding& encoding, const Vec3& value) {
  Vec3 colour;
  for (int c = 0; c < 3; ++c)
    colour[c] = (value[c] - encoding.pedestal) / encoding.Scale() * encoding.white_balance[c];
  const Vec3 developed = encoding.linear_srgb_from_camera * colour;
  return {DisplayValue(developed[0]), DisplayValue(developed[1]), DisplayValue(developed[2])};
}

Result<Image<uint8_t>> LfPicture(const LightField& light_field, const LfImageStore& store,
                                 LfImageId id, int max_side_px) {
  const Intrinsics& k = light_field.Camera(id).intrinsics;
  const int side = SquareSide(k, max_side_px);
  LfPixels pixels;
  LF_ASSIGN_OR_RETURN(
      const int reduction,
      LoadReducedWithoutThrowing(store, id, side, k, light_field.ImagePath(id).string(), &pixels));
  const int factor = side / reduction;  // the reduction that is left to do
  const RadianceEncoding& encoding = light_field.encoding;
  Image<uint8_t> picture((pixels.rect.width() + factor - 1) / factor,
                         (pixels.rect.height() + factor - 1) / factor, 3, kMaskedGrey);
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x) {
      const PixelRect square =
          Intersection(pixels.rect, {x * factor, y * factor, (x + 1) * factor, (y + 1) * factor});
      const std::array<double, 4> sum = SumOf(pixels, square);
      if (!(sum[3] > 0)) continue;
      const std::array<uint8_t, 3> colour =
          DisplayColour(encoding, Vec3(sum[0], sum[1], sum[2]) / sum[3]);
      std::copy(colour.begin(), colour.end(), &picture.at(x, y, 0));
    }
  return picture;
}

}  // namespace lf
