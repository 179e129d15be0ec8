// SPDX-License-Identifier: Apache-2.0
// Grey copies of LF images in reduced size, for the search of depths.
#pragma once

#include <optional>

#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/core/image.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"
#include "lf/storage/load/lf_image_store.h"

namespace lf {

inline constexpr int kMostReducedWidth = 480;  // pixels; limit of LoadReducedImage()

struct ReducedImage {
  // Square root of the mean light of R, G and B, from 0 (black) to 1. Noise of the square root is
  // about equal in shadows and highlights. The mean is taken over divisor x divisor pixels of the
  // LF image; NaN if one of them is masked. The last columns and rows of the LF image are left out
  // if they do not fill a reduced pixel.
  Image<float> light;
  int divisor = 1;

  // Returns the value at a position, interpolated between four reduced pixels; NaN outside the
  // centres of the border pixels, and if one of the four is NaN.
  //   place_px  continuous position in the LF image
  float At(const Vec2& place_px) const;
};

// Returns the smallest divisor that reduces LF images of this width to kMostReducedWidth or less.
int DivisorFor(int width_px);

// Reduces a whole LF image with RGB pixels.
ReducedImage Reduced(const LfPixels& pixels, int divisor);

// Loads an LF image and reduces it. kInput: the image cannot be loaded. kOutput: the machine lacks
// memory or open files.
//   store  a store with Mosaics::kToRgb
Result<ReducedImage> LoadReducedImage(const LightField& light_field, const LfImageStore& store,
                                      LfImageId id);

}  // namespace lf
