// SPDX-License-Identifier: Apache-2.0
// Converts the light of virtual LF images to the numbers that a light field's images store.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lf/core/image.h"
#include "lf/densify/natural_neighbours.h"
#include "lf/light_field/model/light_field.h"
#include "lf/light_field/model/radiance.h"
#include "lf/storage/load/recorded_image.h"

namespace lf {

// Returns the gains of an LF image without falloff whose stored values reach as far as the light of
// these LF images does, above white and below black. They are the largest gains of the LF images,
// divided by the least falloff of each, but no larger than the light that is kept (max_radiance,
// pedestal) requires. They are 1 if the LF images have the gain 1 and no falloff.
ChannelGains GainsToHold(const LightField& light_field, std::span<const WeightedPoint> lf_images);

// The type and the layout of stored values.
struct StoredKind {
  StoredValues values = StoredValues::kUint8;
  PixelLayout layout = PixelLayout::kGrey;
};
// Returns the kind that holds all values of both: floats rather than integers, 16 bits rather than
// 8, and colours rather than grey.
StoredKind KindToHold(const StoredKind& a, const StoredKind& b);

class RecordedValues {
 public:
  RecordedValues(const RadianceEncoding& encoding, const StoredKind& kind);

  // Returns an LF image that is loaded as `light`, up to the steps of the stored values, if its LF
  // camera has these gains and no falloff. For a mosaic, each pixel keeps the colour that its
  // pattern has there; for grey images, it is G. If alpha is light, colours are straight or
  // premultiplied as the encoding says, and opacities are kept, beside 8-bit colours in 255 steps;
  // otherwise opacities have no effect.
  //   light  WorkingImage::light
  RecordedImage Of(const Image<uint16_t>& light, const ChannelGains& gains = {}) const;

 private:
  // Returns, for each 16-bit radiance, the stored value that is nearest to it.
  std::vector<uint16_t> StoredOf(double gain) const;

  // Returns the opacity that is stored.
  uint16_t StoredOpacity(uint16_t opacity) const;

  const RadianceEncoding encoding_;
  const StoredKind kind_;
  const bool has_opacity_, is_straight_;
  std::vector<double> light_;  // [stored value]: its light before the gain; empty for floats
};

}  // namespace lf
