// SPDX-License-Identifier: Apache-2.0
// A mosaic in the form in which mosaics of several LF images are merged. Values are white balanced
// radiance: 1 is display white, and grey has equal values in all colours.
#pragma once

#include <array>

#include "lf/core/geometry.h"
#include "lf/core/image.h"
#include "lf/densify/working_image.h"
#include "lf/light_field/model/lf_pixels.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

struct JointImage {
  static constexpr int kColours = 3;  // R, G, B

  PinholeCamera camera;  // the LF camera
  BayerPattern pattern = BayerPattern::kNone;
  // [height][width]: the recorded value of each pixel; NaN if it is masked.
  Image<float> samples;
  Image<float> rgb;  // [height][width][3]: the mosaic, demosaicked by itself
  // `rgb` filtered by [1 2 1] / 4 in both directions, in which little of the mosaic's pattern is
  // left. NaN if a pixel that takes part is masked.
  Image<float> smooth;
  float mean = 0;  // mean of `smooth`
  // R, G, B from which recorded values may be clipped. Above this, only LF images with as much room
  // can tell more.
  std::array<float, 3> clipped_from = {};
  WorkingImage working;  // for searches of depths; without its member `light`

  int width() const { return samples.width(); }
  int height() const { return samples.height(); }
  // Returns the colour that a pixel recorded: 0, 1 or 2.
  int ColourAt(int x, int y) const { return BayerChannel(pattern, x, y); }
};

// Converts between 16-bit radiance of LF images (light_field/model/radiance.h) and white balanced
// radiance.
class BalancedRadiance {
 public:
  explicit BalancedRadiance(const RadianceEncoding& encoding);
  float Of(uint16_t value, int channel) const {
    return (static_cast<float>(value) - pedestal_) * factors_[static_cast<size_t>(channel)];
  }
  // Returns the radiance before white balance.
  float Radiance(float balanced, int channel) const {
    return balanced / balance_[static_cast<size_t>(channel)];
  }

 private:
  float pedestal_;
  std::array<float, 3> factors_, balance_;
};

// Converts the mosaic of a whole LF image.
//   light_field  of the LF image; its encoding has room for undershoot (MakeRoomForUndershoot())
JointImage JointImageOf(const LightField& light_field, LfImageId id, const LfPixels& mosaic,
                        const ToneCurve& curve);

// Demosaics an LF image as if its pattern began one pixel further to the right: each pixel takes
// that other colour of image.rgb as recorded, so that the colour that it did record is interpolated
// from its neighbours. The difference from the recorded value is about the error of demosaicking.
// [height][width][3], NaN where pixels are masked.
Image<float> DemosaickedWithOtherPattern(const JointImage& image, const RadianceEncoding& encoding);

}  // namespace lf
