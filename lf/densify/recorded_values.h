// SPDX-License-Identifier: Apache-2.0
// Converts the light of virtual LF images to the numbers that a light field's images store.
#pragma once

#include <cstdint>
#include <vector>

#include "lf/core/image.h"
#include "lf/light_field/model/radiance.h"
#include "lf/storage/load/recorded_image.h"

namespace lf {

class RecordedValues {
 public:
  // `values` and `layout` are those of the recorded images (RecordedImage).
  RecordedValues(const RadianceEncoding& encoding, StoredValues values, PixelLayout layout);

  // Returns an LF image of gain 1 that is loaded as `light`, up to the steps of the stored values.
  // Pixels without light are masked. For a mosaic, each pixel keeps the colour that its pattern
  // has there; for grey images, it is G.
  //   light  [height][width][4]: 16-bit radiance R, G, B and 1, or 0
  RecordedImage Of(const Image<uint16_t>& light) const;

 private:
  const RadianceEncoding encoding_;
  const StoredValues values_;
  const PixelLayout layout_;
  std::vector<uint16_t> stored_;  // [16-bit radiance]: the stored value that is nearest to it
};

}  // namespace lf
