// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/demosaic/joint_image.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "lf/core/check.h"
#include "lf/storage/load/demosaic.h"

namespace lf {
namespace {

Image<float> BalancedRgb(const LfPixels& rgb, const BalancedRadiance& balanced) {
  const Image<uint16_t>& from = rgb.radiance;
  Image<float> result(from.width(), from.height(), JointImage::kColours);
  for (int y = 0; y < from.height(); ++y)
    for (int x = 0; x < from.width(); ++x) {
      const bool masked = from.at(x, y, LfPixels::kRayLane) == 0;
      for (int c = 0; c < JointImage::kColours; ++c)
        result.at(x, y, c) = masked ? NAN : balanced.Of(from.at(x, y, c), c);
    }
  return result;
}

Image<float> Smoothed(const Image<float>& rgb) {
  const int width = rgb.width(), height = rgb.height();
  Image<float> rows(width, height, JointImage::kColours),
      result(width, height, JointImage::kColours);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < JointImage::kColours; ++c)
        rows.at(x, y, c) = 0.25F * (rgb.at(std::max(x - 1, 0), y, c) + 2 * rgb.at(x, y, c) +
                                    rgb.at(std::min(x + 1, width - 1), y, c));
  for (int y = 0; y < height; ++y) {
    const float* const above = rows.row(std::max(y - 1, 0));
    const float* const at = rows.row(y);
    const float* const below = rows.row(std::min(y + 1, height - 1));
    float* const out = result.row(y);
    for (int i = 0; i < width * JointImage::kColours; ++i)
      out[i] = 0.25F * (above[i] + 2 * at[i] + below[i]);
  }
  return result;
}

// Returns the mean of the values that are not masked.
float MeanOf(const Image<float>& smooth) {
  double sum = 0, count = 0;
  for (const float value : smooth.pixels()) {
    if (std::isnan(value)) continue;
    sum += value;
    ++count;
  }
  return count > 0 ? static_cast<float>(sum / count) : 0;
}

// Returns the pattern of the same sensor if its pixels are counted from the second column on.
BayerPattern OneColumnFurther(BayerPattern pattern) {
  for (const BayerPattern other :
       {BayerPattern::kRggb, BayerPattern::kBggr, BayerPattern::kGrbg, BayerPattern::kGbrg})
    if (BayerChannel(other, 0, 0) == BayerChannel(pattern, 1, 0) &&
        BayerChannel(other, 0, 1) == BayerChannel(pattern, 1, 1))
      return other;
  LF_CHECK(false);
  return pattern;
}

// Returns the light, before gain, that sensors can record at most: white, unless light above white
// was recorded, as max_radiance tells.
double ClippedLight(const LightField& light_field) {
  const RadianceEncoding& encoding = light_field.encoding;
  double most_gain = 1;
  for (const LfCamera& camera : light_field.cameras)
    for (const float gain : camera.gain.of_channels)
      most_gain = std::max(most_gain, static_cast<double>(gain));
  if (encoding.max_radiance <= most_gain || encoding.transfer != Transfer::kLinear ||
      !encoding.white_level)
    return 1;
  const double largest = *encoding.white_level > 255 ? 65535 : 255;
  return std::max(
      1.0, (largest - encoding.black_level) / (*encoding.white_level - encoding.black_level));
}

}  // namespace

BalancedRadiance::BalancedRadiance(const RadianceEncoding& encoding)
    : pedestal_(static_cast<float>(encoding.pedestal)) {
  for (size_t c = 0; c < balance_.size(); ++c) {
    balance_[c] = static_cast<float>(encoding.white_balance[c]);
    factors_[c] = static_cast<float>(encoding.white_balance[c] / encoding.Scale());
  }
}

JointImage JointImageOf(const LightField& light_field, LfImageId id, const LfPixels& mosaic,
                        const ToneCurve& curve) {
  LF_CHECK(mosaic.bayer != BayerPattern::kNone);
  const RadianceEncoding& encoding = light_field.encoding;
  const BalancedRadiance balanced(encoding);
  JointImage image;
  image.camera = light_field.Camera(id);
  image.pattern = mosaic.bayer;
  const int width = mosaic.rect.width(), height = mosaic.rect.height();
  image.samples = Image<float>(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      image.samples.at(x, y) =
          mosaic.IsMasked(x, y) ? NAN : balanced.Of(mosaic.radiance.at(x, y), image.ColourAt(x, y));
  LfPixels rgb;
  Demosaic(mosaic, width, height, encoding, mosaic.rect, &rgb);
  image.working = WorkingImageOf(image.camera, rgb, 1, curve);
  image.working.light = {};
  image.rgb = BalancedRgb(rgb, balanced);
  image.smooth = Smoothed(image.rgb);
  image.mean = MeanOf(image.smooth);
  constexpr double kClippedShare = 0.98;
  const ChannelGains& gain = light_field.cameras[id.value].gain;
  const double light = ClippedLight(light_field);
  for (size_t c = 0; c < image.clipped_from.size(); ++c)
    image.clipped_from[c] = static_cast<float>(kClippedShare * encoding.white_balance[c] *
                                               std::min(encoding.max_radiance, light * gain[c]));
  return image;
}

Image<float> DemosaickedWithOtherPattern(const JointImage& image,
                                         const RadianceEncoding& encoding) {
  const int width = image.width(), height = image.height();
  LfPixels other({0, 0, width, height}, OneColumnFurther(image.pattern));
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const int c = BayerChannel(other.bayer, x, y);
      const float value = image.rgb.at(x, y, c);
      if (std::isnan(value)) {
        other.Mask(x, y);
        continue;
      }
      const double radiance = value / encoding.white_balance[static_cast<size_t>(c)];
      other.radiance.at(x, y) = static_cast<uint16_t>(std::clamp(
          std::floor(radiance * encoding.Scale() + encoding.pedestal + 0.5), 0.0, 65535.0));
    }
  LfPixels rgb;
  Demosaic(other, width, height, encoding, other.rect, &rgb);
  return BalancedRgb(rgb, BalancedRadiance(encoding));
}

}  // namespace lf
