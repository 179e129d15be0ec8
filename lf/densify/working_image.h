// SPDX-License-Identifier: Apache-2.0
// An LF image in the form that the densifier works with: RGB with opacity, without lens distortion,
// perhaps reduced.
#pragma once

#include <cstdint>

#include "lf/camera/pinhole.h"
#include "lf/core/ids.h"
#include "lf/core/image.h"
#include "lf/core/result.h"
#include "lf/densify/pair_map.h"
#include "lf/light_field/model/lf_pixels.h"
#include "lf/light_field/model/light_field.h"
#include "lf/storage/load/lf_image_store.h"

namespace lf {

struct WorkingImage {
  PinholeCamera camera;  // without distortion and vignetting
  // [height][width][4]: 16-bit radiance R, G, B over black, and the opacity as a value of
  // RecordedImage::opacities: kOpaqueOpacity if nothing is seen through the pixel, 0 in all four
  // lanes if it is masked.
  Image<uint16_t> light;
  // [height][width][4]: R, G, B from 0 to 255 on a tone curve, and the opacity from
  // kTransparentTone to 255; all 0 if the pixel is masked. A masked pixel is unknown, and a
  // transparent one is known to show nothing: these differ as much as any two pixels.
  Image<uint16_t> tones;
  Image<uint16_t> compared = {};  // ComparedTones() of `tones`, for costs of matches
  // [height][width]: 1 if the pixel and the eight around it are transparent, otherwise 0. Nothing
  // is along the ray of such a pixel, also if its LF camera is a little wrong. Empty if there is
  // no such pixel.
  Image<uint8_t> empty = {};
  // [height][width]: 1 for pixels that are masked or transparent, and have no depth, otherwise 0.
  // Empty if there is no such pixel.
  Image<uint8_t> without_depth = {};
  uint16_t black = 0;  // 16-bit radiance of no light
  int width() const { return tones.width(); }
  int height() const { return tones.height(); }
};

inline constexpr int kTransparentTone = 80;
// Returns true if a pixel is not masked and shows next to nothing.
//   tones  its four tones
bool IsTransparent(const uint16_t* tones);

// Returns the number of pixels that are not transparent.
size_t ShownCount(const Image<uint16_t>& tones);

// Returns WorkingImage::empty.
Image<uint8_t> EmptyPixels(const Image<uint16_t>& tones);
// Returns WorkingImage::without_depth.
Image<uint8_t> PixelsWithoutDepth(const Image<uint16_t>& tones);

// Returns true if the mask marks the pixel at a place in front of its camera.
inline bool IsMarkedAt(const Image<uint8_t>& mask, const PairMap::Place& place) {
  return place.w > 0 && place.u_px >= 0 && place.v_px >= 0 &&
         place.u_px < static_cast<float>(mask.width()) &&
         place.v_px < static_cast<float>(mask.height()) &&
         mask.at(static_cast<int>(place.u_px), static_cast<int>(place.v_px)) != 0;
}

// Returns the sum of the absolute differences of green beside and above a pixel, which must not be
// on the border. It is 0 beside an outline, where the opacity changes: the place of an outline says
// little about depth.
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
  uint16_t black() const { return black_; }  // 16-bit radiance of no light

 private:
  uint16_t black_;
  std::vector<uint8_t> tones_;
};

// Makes a working image of a whole LF image with RGB pixels. A reduced pixel is the mean of divisor
// x divisor pixels. Pixels that the LF image does not show are masked.
WorkingImage WorkingImageOf(const PinholeCamera& lf_camera, const LfPixels& pixels, int divisor,
                            const ToneCurve& curve);

// Returns the image with tones that are means of divisor x divisor tones, for comparing alone: it
// has no light.
WorkingImage ReducedTones(const WorkingImage& image, int divisor);

// Returns the light field with the opacities of its LF images, if they have some, in place of a
// background.
LightField WithOpacities(LightField light_field);

// Loads an LF image and converts it.
//   light_field  WithOpacities()
//   store        of `light_field`, with Mosaics::kToRgb
// Errors of store.Load().
Result<WorkingImage> LoadWorkingImage(const LightField& light_field, const LfImageStore& store,
                                      LfImageId id, int divisor, const ToneCurve& curve);

}  // namespace lf
