// SPDX-License-Identifier: Apache-2.0
// An LF image in the form that the densifier works with: RGB, without lens distortion, perhaps
// reduced.
#pragma once

#include <cstdint>

#include "lf/camera/pinhole.h"
#include "lf/core/ids.h"
#include "lf/core/image.h"
#include "lf/core/result.h"
#include "lf/light_field/model/lf_pixels.h"
#include "lf/light_field/model/light_field.h"
#include "lf/storage/load/lf_image_store.h"

namespace lf {

struct WorkingImage {
  PinholeCamera camera;   // without distortion and vignetting
  Image<uint16_t> light;  // [height][width][4]: 16-bit radiance R, G, B and 1; 0 if masked
  Image<uint16_t> tones;  // [height][width][4]: R, G, B from 0 to 255 on a tone curve, for
                          // comparing; the last is 255, or 0 if the pixel is masked
  int width() const { return light.width(); }
  int height() const { return light.height(); }
};

// Returns the sum of the absolute differences of green beside and above a pixel, which must not be
// on the border.
int TextureAt(const Image<uint16_t>& tones, int x, int y);

// Returns the camera of a working image: a pinhole with the calibration matrix and the size of the
// LF camera, divided by `divisor`.
PinholeCamera WorkingCamera(const PinholeCamera& lf_camera, int divisor);

// Maps 16-bit radiance to a tone between 0 and 255: the sRGB curve of x (1 + x / m^2) / (1 + x),
// where x is the radiance and m the largest one. This is x if m is 1; otherwise it compresses
// highlights (Reinhard et al., "Photographic tone reproduction for digital images", 2002, Eq. 4).
class ToneCurve {
 public:
  explicit ToneCurve(const RadianceEncoding& encoding);
  uint8_t Tone(uint16_t radiance) const { return tones_[radiance]; }

 private:
  std::vector<uint8_t> tones_;
};

// Makes a working image of a whole LF image with RGB pixels. A reduced pixel is the mean of divisor
// x divisor pixels. Pixels that the LF image does not show are masked.
WorkingImage WorkingImageOf(const PinholeCamera& lf_camera, const LfPixels& pixels, int divisor,
                            const ToneCurve& curve);

// Loads an LF image and converts it.
//   store  a store with Mosaics::kToRgb
// Errors of store.Load().
Result<WorkingImage> LoadWorkingImage(const LightField& light_field, const LfImageStore& store,
                                      LfImageId id, int divisor, const ToneCurve& curve);

}  // namespace lf
