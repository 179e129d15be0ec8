// Shows LF images as pictures for people.
#pragma once

#include <cstdint>

#include "lf/core/ids.h"
#include "lf/core/image.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"
#include "lf/storage/load/lf_image_store.h"

namespace lf {

// Returns [height][width][3] sRGB, developed like frames (white balance, colour matrix, gain). If
// the image is larger than max_side_px, each pixel is the mean of a square of its pixels. Masked
// pixels are grey.
//   store  must have Mosaics::kToRgb
// kInput: errors of store.Load().
Result<Image<uint8_t>> LfPicture(const LightField& light_field, const LfImageStore& store,
                                 LfImageId id, int max_side_px);

}  // namespace lf
