// LF images as depth is searched in them: grey, a few hundred pixels wide.
#pragma once

#include <optional>

#include "lf/capture/light_field.h"
#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/core/image.h"
#include "lf/core/result.h"
#include "lf/store/lf_image_store.h"

namespace lf {

inline constexpr int kMostReducedWidth = 480;

struct ReducedImage {
  // The root of light, black 0 and the brightest 1 (noise is about as large everywhere); NaN where
  // nothing was recorded. A pixel is the mean of divisor x divisor pixels of the LF image, of which
  // columns and rows at the end may be left out.
  Image<float> light;
  int divisor = 1;

  // Returns the light between pixels: NaN beyond the image, and if one of the four pixels around
  // was not recorded.
  //   place_px  in the LF image, continuous
  float At(const Vec2& place_px) const;
};

// The divisor of images of this width.
int DivisorFor(int width_px);

// Reduces a whole LF image in RGB.
ReducedImage Reduced(const LfPixels& pixels, int divisor);

// kInput: the image cannot be loaded.
//   store  one with Mosaics::kToRgb
Result<ReducedImage> LoadReducedImage(const LightField& light_field, const LfImageStore& store,
                                      LfImageId id);

}  // namespace lf
