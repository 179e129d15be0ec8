// Reduced LF images for the search of depths: grey, a few hundred pixels wide.
#pragma once

#include <optional>

#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/core/image.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"
#include "lf/storage/load/lf_image_store.h"

namespace lf {

inline constexpr int kMostReducedWidth = 480;

struct ReducedImage {
  // Square root of light, from 0 (black) to 1, in which noise is about equal everywhere; NaN if
  // nothing was recorded. A pixel is the root of the mean light of divisor x divisor pixels of the
  // LF image, whose last columns and rows may be left out.
  Image<float> light;
  int divisor = 1;

  // Returns the light between pixels: NaN beyond the image, and if one of the four pixels around
  // was not recorded.
  //   place_px  in the LF image, continuous
  float At(const Vec2& place_px) const;
};

// Returns the divisor for LF images of this width.
int DivisorFor(int width_px);

// Reduces a whole LF image in RGB.
ReducedImage Reduced(const LfPixels& pixels, int divisor);

// Loads an LF image and reduces it. kInput: the image cannot be loaded.
//   store  one with Mosaics::kToRgb
Result<ReducedImage> LoadReducedImage(const LightField& light_field, const LfImageStore& store,
                                      LfImageId id);

}  // namespace lf
